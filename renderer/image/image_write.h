#pragma once
// Writes pictures to files. The extension chooses the format: .exr, .png, .jpg, .tif or .hdr.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/file/atomic_file.h"
#include "renderer/image/display.h"
#include "renderer/image/image_format.h"
#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Channels by layer, with the names that read_image() gives.
using LayerChannels = std::map<std::string, std::vector<std::string>>;

/// An EXR of which some channels change.
struct EditedExr {
  std::filesystem::path file;
  LayerChannels channels;
};

struct ImageWriteOptions {
  bool exr_float = false;  ///< all layers as 32-bit float; otherwise half, except Layer::full_precision
  int bits = 8;            ///< of PNG and TIFF: 8 or 16
  DisplayOptions display;  ///< of PNG, JPEG and TIFF; EXR and HDR keep the scene's radiance
  std::optional<EditedExr> edited;  ///< an EXR is that file, with these channels of the picture
};

/// Throws UnknownFormat, OutputError or MissingLibrary if write_image() cannot write to `path`.
void check_image_output(const std::filesystem::path& path);

/// displayed() in bytes, three a pixel; with alpha over black.
std::vector<std::uint8_t> display_bytes(const Picture& picture, const DisplayOptions& options = {});

/// The content of a file. Throws OutputError, or what displayed() throws.
std::vector<std::uint8_t> encode_image(const Picture& picture, ImageFormat format,
                                       const ImageWriteOptions& options = {});

/// An EXR holds every layer and has the metadata in its header, with ZIP compression. Its data window is the
/// picture, its display window the full picture. Of an edited one all else keeps its bits, but for layers
/// that the picture does not have. The same picture gives the same bytes. The other formats hold the beauty
/// layer: PNG and TIFF as displayed, with straight alpha; JPEG (quality 92) the same over black; HDR its
/// radiance. The file is either complete or unchanged (AtomicFile). Throws UnknownFormat, OutputError, or
/// what displayed() throws.
void write_image(const Picture& picture, const std::filesystem::path& path,
                 const ImageWriteOptions& options = {});

}  // namespace gatelight::renderer
