#include "renderer/image/image_format.h"

#include <algorithm>
#include <string>

namespace gatelight::renderer {

ImageFormat image_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  if (extension == ".exr") return ImageFormat::exr;
  if (extension == ".png") return ImageFormat::png;
  if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::jpeg;
  if (extension == ".tif" || extension == ".tiff") return ImageFormat::tiff;
  if (extension == ".hdr") return ImageFormat::hdr;
  return ImageFormat::unknown;
}

}  // namespace gatelight::renderer
