#include "renderer/image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "renderer/image/claimed_size.h"
#include "renderer/image/color_channels.h"
#include "renderer/image/cryptomatte.h"

namespace gatelight::renderer {
namespace {

/// The sort key of a channel: colour and vector channels in their usual order, then all others.
int channel_rank(std::string_view channel) {
  constexpr std::string_view kOrder = "RGBAXYZ";
  const std::size_t at = channel.size() == 1 ? kOrder.find(channel) : std::string_view::npos;
  return at == std::string_view::npos ? static_cast<int>(kOrder.size()) : static_cast<int>(at);
}

std::vector<Layer> find_layers(const Imf::ChannelList& channels) {
  std::vector<Layer> layers;
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      throw std::runtime_error(fmt::format("channel '{}' is subsampled, which is not supported", it.name()));
    }
    const std::string full = it.name();
    const std::size_t dot = full.rfind('.');
    const std::string name = dot == std::string::npos ? "" : full.substr(0, dot);
    auto layer = std::find_if(layers.begin(), layers.end(), [&](const Layer& l) { return l.name == name; });
    if (layer == layers.end()) layer = layers.insert(layers.end(), Layer{.name = name});
    layer->channels.push_back(dot == std::string::npos ? full : full.substr(dot + 1));
    layer->full_precision |= it.channel().type != Imf::HALF;
  }
  for (Layer& layer : layers) {
    std::stable_sort(
        layer.channels.begin(), layer.channels.end(),
        [](const std::string& a, const std::string& b) { return channel_rank(a) < channel_rank(b); });
  }
  const auto first = [&](auto condition) { return std::find_if(layers.begin(), layers.end(), condition); };
  auto beauty = first([](const Layer& l) { return l.name.empty() && color_channels(l); });
  // A grey layer with a name is depth or a mask.
  const auto has_rgb = [](const Layer& l) {
    const auto index = color_channels(l);
    return index && (*index)[0] != (*index)[1];
  };
  if (beauty == layers.end()) beauty = first(has_rgb);
  if (beauty == layers.end()) beauty = first([](const Layer& l) { return l.name.empty(); });
  if (beauty != layers.end()) std::rotate(layers.begin(), beauty, beauty + 1);
  return layers;
}

}  // namespace

Picture read_exr(const std::filesystem::path& path) {
  Imf::InputFile file(path.c_str(), 0);
  const Imf::Header& header = file.header();
  const Imath::Box2i data = header.dataWindow();
  const Imath::Box2i display = header.displayWindow();

  Picture picture;
  picture.width = data.max.x - data.min.x + 1;
  picture.height = data.max.y - data.min.y + 1;
  picture.x0 = data.min.x - display.min.x;
  picture.y0 = data.min.y - display.min.y;
  picture.full_width = display.max.x - display.min.x + 1;
  picture.full_height = display.max.y - display.min.y + 1;
  picture.layers = find_layers(header.channels());

  const std::size_t width = static_cast<std::size_t>(picture.width);
  const std::size_t pixels = width * static_cast<std::size_t>(picture.height);
  std::size_t channels = 0;
  for (const Layer& layer : picture.layers) channels += layer.channels.size();
  if (channels == 0) throw std::runtime_error("it has no channels");
  check_claimed_size(picture.width, picture.height, static_cast<std::int64_t>(channels), path);

  Imf::FrameBuffer frame;
  for (Layer& layer : picture.layers) {
    const std::size_t count = layer.channels.size();
    layer.values.resize(pixels * count);
    const std::size_t pixel_bytes = count * sizeof(float);
    // The address of the pixel (0, 0), to which the library adds the offset of the data window. A data window
    // may lie anywhere, so the address is an integer that may wrap, not a pointer.
    const std::uintptr_t origin = reinterpret_cast<std::uintptr_t>(layer.values.data()) -
                                  static_cast<std::uintptr_t>(data.min.x) * pixel_bytes -
                                  static_cast<std::uintptr_t>(data.min.y) * pixel_bytes * width;
    for (std::size_t c = 0; c < count; ++c) {
      const std::string name = layer.name.empty() ? layer.channels[c] : layer.name + "." + layer.channels[c];
      // NOLINTNEXTLINE(performance-no-int-to-ptr): see above
      char* const channel = reinterpret_cast<char*>(origin + c * sizeof(float));
      frame.insert(name, Imf::Slice(Imf::FLOAT, channel, pixel_bytes, pixel_bytes * width));
    }
  }
  file.setFrameBuffer(frame);
  file.readPixels(data.min.y, data.max.y);

  constexpr std::string_view kPrefix = "gatelight:";
  for (auto it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    const std::string_view name = it.name();
    if (text == nullptr) continue;
    if (name.starts_with(kPrefix)) picture.metadata.emplace(name.substr(kPrefix.size()), text->value());
    if (name.starts_with(kCryptomattePrefix)) picture.attributes.emplace(name, text->value());
  }
  return picture;
}

}  // namespace gatelight::renderer
