#include "renderer/image/image_format.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace gatelight::renderer {
namespace {

struct Extension {
  std::string_view text;
  ImageFormat format;
};
/// The first one of a format is the usual one.
constexpr Extension kExtensions[] = {{".exr", ImageFormat::exr},  {".png", ImageFormat::png},
                                     {".jpg", ImageFormat::jpeg}, {".jpeg", ImageFormat::jpeg},
                                     {".tif", ImageFormat::tiff}, {".tiff", ImageFormat::tiff},
                                     {".hdr", ImageFormat::hdr}};

}  // namespace

ImageFormat image_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  for (const Extension& known : kExtensions) {
    if (known.text == extension) return known.format;
  }
  return ImageFormat::unknown;
}

std::string_view extension_of(ImageFormat format) {
  return std::find_if(std::begin(kExtensions), std::end(kExtensions),
                      [&](const Extension& known) { return known.format == format; })
      ->text;
}

}  // namespace gatelight::renderer
