#include "renderer/image/image_write.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <memory>

#include "renderer/image/exr.h"
#include "renderer/image/image_format.h"

namespace gatelight::renderer {
namespace {

void write_png(const Picture& picture, AtomicFile& file, const ImageWriteOptions& options) {
  const std::vector<std::uint8_t> bytes = display_bytes(picture, options);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  // Rendered pictures hold noise, of which filters of rows make little.
  image.flags = PNG_IMAGE_FLAG_FAST;
  // The PNG is encoded in memory, so that AtomicFile reports every error of the disk.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  const auto encoded = std::make_unique_for_overwrite<std::uint8_t[]>(size);
  if (png_image_write_to_memory(&image, encoded.get(), &size, 0, bytes.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  file.write(encoded.get(), size);
}

void require_writable_format(const std::filesystem::path& path) {
  const ImageFormat format = image_format(path);
  if (format != ImageFormat::exr && format != ImageFormat::png) {
    throw UnknownFormat(fmt::format("cannot write '{}': its extension is '{}', supported are .exr and .png",
                                    path.string(), path.extension().string()));
  }
}

}  // namespace

ImageFormat image_format(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c); });
  if (extension == ".exr") return ImageFormat::exr;
  if (extension == ".png") return ImageFormat::png;
  if (extension == ".hdr") return ImageFormat::hdr;
  return ImageFormat::unknown;
}

std::vector<std::uint8_t> display_bytes(const Picture& picture, const ImageWriteOptions& options) {
  const Layer& beauty = picture.layers.front();
  const std::size_t channels = beauty.channels.size();
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  const float scale = exposure_scale(options.exposure);
  std::vector<std::uint8_t> bytes(3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    scene::Color color;
    for (std::size_t c = 0; c < 3; ++c) {
      color[static_cast<Eigen::Index>(c)] = beauty.values[p * channels + std::min(c, channels - 1)];
    }
    const std::array<std::uint8_t, 3> shown = display_color(color, scale, options.tonemap);
    std::copy(shown.begin(), shown.end(), &bytes[3 * p]);
  }
  return bytes;
}

void check_image_output(const std::filesystem::path& path) {
  require_writable_format(path);
  check_writable(path);
}

void write_image(const Picture& picture, const std::filesystem::path& path,
                 const ImageWriteOptions& options) {
  require_writable_format(path);
  AtomicFile file(path);
  try {
    if (image_format(path) == ImageFormat::exr) {
      write_exr(picture, file.stream(), options.exr_float);
    } else {
      write_png(picture, file, options);
    }
  } catch (const OutputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(fmt::format("cannot write '{}': {}", path.string(), error.what()));
  }
  file.commit();
}

}  // namespace gatelight::renderer
