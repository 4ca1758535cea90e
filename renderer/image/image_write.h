#pragma once
// Writes pictures to files. The extension chooses the format: .exr or .png.

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "renderer/image/picture.h"
#include "renderer/image/tonemap.h"
#include "renderer/machine/atomic_file.h"

namespace gatelight::renderer {

struct ImageWriteOptions {
  bool exr_float = false;  ///< all layers as 32-bit float; otherwise half, except Layer::full_precision
  float exposure = 0.0f;   ///< in stops; PNG only, EXR keeps the scene's radiance
  Tonemap tonemap = Tonemap::none;  ///< PNG only
};

/// Thrown for an extension that is not supported. The message names the file and the supported extensions.
struct UnknownFormat : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// Throws UnknownFormat or OutputError if write_image() cannot write to `path`.
void check_image_output(const std::filesystem::path& path);

/// The beauty layer as a screen shows it: R, G, B of each pixel in sRGB. A layer of one channel is grey.
std::vector<std::uint8_t> display_bytes(const Picture& picture, const ImageWriteOptions& options = {});

/// An EXR holds every layer and has the metadata in its header, with ZIP compression. Its data window is the
/// picture, its display window the full picture. The same picture gives the same bytes. A PNG holds the
/// beauty layer in 8 bits, sRGB. The file is either complete or unchanged (AtomicFile). Throws UnknownFormat
/// or OutputError.
void write_image(const Picture& picture, const std::filesystem::path& path,
                 const ImageWriteOptions& options = {});

}  // namespace gatelight::renderer
