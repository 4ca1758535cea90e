#pragma once
// Pictures into files. The extension chooses the format: .exr or .png.

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "renderer/image/picture.h"
#include "renderer/image/tonemap.h"
#include "renderer/machine/atomic_file.h"

namespace gatelight::renderer {

struct ImageWriteOptions {
  bool exr_float = false;  ///< 32 bits for all layers; else half for those without Layer::full_precision
  float exposure = 0.0f;   ///< stops; PNG only, EXR keeps the scene's radiance
  Tonemap tonemap = Tonemap::none;  ///< PNG only
};

/// A file name whose extension no writer or reader knows. The message names the file and the supported ones.
struct UnknownFormat : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Throws UnknownFormat or OutputError if write_image() could not write there.
void check_image_output(const std::filesystem::path& path);

/// The beauty layer as a screen shows it: R, G, B of each pixel in sRGB; a layer of one channel is grey.
std::vector<std::uint8_t> display_bytes(const Picture& picture, const ImageWriteOptions& options = {});

/// EXR: every layer, data window = the picture, display window = the full picture, metadata in the header,
/// zip compression; the same picture gives the same bytes. PNG: the beauty layer, 8 bits, sRGB. The file is
/// whole or untouched (AtomicFile). Throws UnknownFormat or OutputError.
void write_image(const Picture& picture, const std::filesystem::path& path,
                 const ImageWriteOptions& options = {});

}  // namespace gatelight::renderer
