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

/// An existing EXR in which some channels are replaced.
struct EditedExr {
  std::filesystem::path file;
  LayerChannels channels;
};

struct ImageWriteOptions {
  bool exr_float = false;  ///< all layers as 32-bit float; otherwise half, except Layer::full_precision
  int bits = 8;            ///< per channel of PNG and TIFF: 8 or 16
  DisplayOptions display;  ///< of PNG, JPEG and TIFF; EXR and HDR keep the scene's radiance
  std::optional<EditedExr> edited;  ///< EXR output: a copy of this file with replaced channels
};

/// Throws UnknownFormat, OutputError or MissingLibrary if write_image() cannot write to `path`.
void check_image_output(const std::filesystem::path& path);

/// displayed() as bytes, three per pixel; transparent pixels are put over black.
std::vector<std::uint8_t> display_bytes(const Picture& picture, const DisplayOptions& options = {});

/// Returns the content of a file. Throws OutputError, or what displayed() throws.
std::vector<std::uint8_t> encode_image(const Picture& picture, ImageFormat format,
                                       const ImageWriteOptions& options = {});

/// An EXR file holds every layer, with ZIP compression, and the metadata in its header. Its data window is
/// the picture, its display window the full picture. An edited EXR loses the layers that the picture lacks;
/// everything else except the replaced channels keeps its bits. The same picture gives the same bytes. The
/// other formats hold the beauty layer: PNG and TIFF as displayed, with straight alpha; JPEG (quality 92) as
/// displayed over black; HDR as radiance. The file is either complete or unchanged (AtomicFile). Throws
/// UnknownFormat, OutputError, or what displayed() throws.
void write_image(const Picture& picture, const std::filesystem::path& path,
                 const ImageWriteOptions& options = {});

}  // namespace gatelight::renderer
