#include "renderer/image/image_read.h"

#include <fmt/format.h>

#include <cstdint>

#include "base/errors.h"
#include "base/image/claimed_size.h"
#include "base/image/png_read.h"
#include "renderer/image/exr.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_library.h"
#include "renderer/image/image_write.h"
#include "renderer/image/srgb.h"

namespace gatelight::renderer {
namespace {

std::vector<std::string> channel_names(int channels) {
  switch (channels) {
    case 1:
      return {"Y"};
    case 2:
      return {"Y", "A"};
    case 3:
      return {"R", "G", "B"};
    default:
      return {"R", "G", "B", "A"};
  }
}

Picture one_layer(int width, int height, int channels) {
  Picture picture{.width = width, .height = height};
  Layer beauty{.channels = channel_names(channels)};
  beauty.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                       static_cast<std::size_t>(channels));
  picture.layers.push_back(std::move(beauty));
  return picture;
}

Picture read_png(const std::filesystem::path& path) {
  PngReader reader = open_png(path);
  check_claimed_size(reader.width(), reader.height(), reader.channels(), path);
  const std::vector<std::uint16_t> pixels = reader.read_16();
  Picture picture = one_layer(reader.width(), reader.height(), reader.channels());
  Layer& beauty = picture.layers.front();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const float value = static_cast<float>(pixels[i]) / 65535.0f;
    beauty.values[i] = beauty.channels[i % beauty.channels.size()] == "A" ? value : srgb_to_linear(value);
  }
  return picture;
}

Picture read_as(ImageFormat format, const std::filesystem::path& path) {
  if (format == ImageFormat::exr) return read_exr(path);
  return format == ImageFormat::png ? read_png(path) : image_library().read_hdr(path);
}

/// A library's message, without the end of a sentence.
std::string reason_of(const std::exception& error) {
  std::string text = one_line(error.what());
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

}  // namespace

void check_image_input(const std::filesystem::path& path) {
  const ImageFormat format = image_format(path);
  if (format != ImageFormat::exr && format != ImageFormat::hdr && format != ImageFormat::png) {
    throw UnknownFormat(
        fmt::format("cannot read '{}': its extension is '{}', supported are .exr, .hdr and .png",
                    path.string(), path.extension().string()));
  }
  check_codec(format);
}

Picture read_image(const std::filesystem::path& path) {
  check_image_input(path);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(fmt::format("cannot read '{}': there is no such file", path.string()));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(fmt::format("cannot read '{}': it is not a regular file", path.string()));
  }
  try {
    return read_as(image_format(path), path);
  } catch (const MissingLibrary&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& reason) {
    throw InputError(fmt::format("cannot read '{}': {}", path.string(), reason_of(reason)));
  }
}

}  // namespace gatelight::renderer
