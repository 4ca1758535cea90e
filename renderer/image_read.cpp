#include "renderer/image_read.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "renderer/claimed_size.h"
#include "renderer/exr.h"
#include "renderer/image_format.h"
#include "renderer/image_write.h"
#include "renderer/srgb.h"

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

/// PNG and HDR.
Picture read_flat(const std::filesystem::path& path, bool srgb) {
  // By its name alone: else a file that is no PNG is tried with every format that the library knows.
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(srgb ? "png" : "hdr");
  if (!input) throw std::runtime_error(OIIO::geterror());
  OIIO::ImageSpec config;
  // Colours as they stand in the file, not multiplied by alpha.
  config.attribute("oiio:UnassociatedAlpha", 1);
  OIIO::ImageSpec spec;
  if (!input->open(path.string(), spec, config)) throw std::runtime_error(input->geterror());
  check_claimed_size(spec.width, spec.height, spec.nchannels, path);

  Picture picture{.width = spec.width, .height = spec.height};
  const int channels = std::min(spec.nchannels, 4);
  Layer beauty{.channels = channel_names(channels), .full_precision = !srgb};
  const std::size_t stride = static_cast<std::size_t>(channels);
  beauty.values.resize(static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) * stride);
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, beauty.values.data())) {
    throw std::runtime_error(input->geterror());
  }
  if (srgb) {
    for (std::size_t i = 0; i < beauty.values.size(); ++i) {
      if (beauty.channels[i % stride] != "A") beauty.values[i] = srgb_to_linear(beauty.values[i]);
    }
  }
  picture.layers.push_back(std::move(beauty));
  return picture;
}

/// The libraries' messages end in line breaks and name the file again.
std::string one_line(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
  }
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

}  // namespace

Picture read_image(const std::filesystem::path& path) {
  const ImageFormat format = image_format(path);
  if (format == ImageFormat::unknown) {
    throw UnknownFormat(
        fmt::format("cannot read '{}': its extension is '{}', supported are .exr, .hdr and .png",
                    path.string(), path.extension().string()));
  }
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw ImageError(fmt::format("cannot read '{}': there is no such file", path.string()));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw ImageError(fmt::format("cannot read '{}': it is not a regular file", path.string()));
  }
  try {
    return format == ImageFormat::exr ? read_exr(path) : read_flat(path, format == ImageFormat::png);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& reason) {
    throw ImageError(fmt::format("cannot read '{}': {}", path.string(), one_line(reason.what())));
  }
}

}  // namespace gatelight::renderer
