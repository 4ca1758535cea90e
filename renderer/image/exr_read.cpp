#include "renderer/image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "base/image/claimed_size.h"
#include "renderer/image/color_channels.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/image/short_name.h"

namespace gatelight::renderer {
namespace {

/// The sort key of a channel: colour and vector channels in their usual order, then all others.
int channel_rank(std::string_view channel) {
  constexpr std::string_view kOrder = "RGBAXYZ";
  const std::size_t at = channel.size() == 1 ? kOrder.find(channel) : std::string_view::npos;
  return at == std::string_view::npos ? static_cast<int>(kOrder.size()) : static_cast<int>(at);
}

/// A layer, and where its values are in the file.
struct StoredLayer {
  Layer layer;
  int part = 0;
  std::vector<std::string> channels;  ///< their full names in the part
};

/// The first subsampled channel; empty where there is none.
std::string subsampled_channel(const Imf::ChannelList& channels) {
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) return it.name();
  }
  return "";
}

/// Adds the layers of a part that are not there yet: views of the same names are not distinguished. Channels
/// without a layer belong to one with the name of their part, where the file has several.
void add_layers(const Imf::Header& header, int part, const std::string& part_name,
                std::vector<StoredLayer>& layers) {
  std::vector<StoredLayer> own;
  const Imf::ChannelList& channels = header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    const std::string full = it.name();
    const std::size_t dot = full.rfind('.');
    const std::string name = dot == std::string::npos ? part_name : full.substr(0, dot);
    auto stored = std::find_if(own.begin(), own.end(), [&](const auto& s) { return s.layer.name == name; });
    if (stored == own.end())
      stored = own.insert(own.end(), StoredLayer{.layer = {.name = name}, .part = part});
    stored->layer.channels.push_back(dot == std::string::npos ? full : full.substr(dot + 1));
    stored->layer.full_precision |= it.channel().type != Imf::HALF;
  }
  for (StoredLayer& stored : own) {
    Layer& layer = stored.layer;
    std::stable_sort(
        layer.channels.begin(), layer.channels.end(),
        [](const std::string& a, const std::string& b) { return channel_rank(a) < channel_rank(b); });
    for (const std::string& channel : layer.channels) {
      const std::string full = layer.name + "." + channel;
      stored.channels.push_back(channels.findChannel(full) ? full : channel);
    }
    if (std::none_of(layers.begin(), layers.end(), [&](const auto& s) { return s.layer.name == layer.name; }))
      layers.push_back(std::move(stored));
  }
}

/// Whether the last component of a layer's name is one that renderers give the picture itself.
bool is_called_beauty(const std::string& layer) {
  const std::string name = short_name(layer);
  return name.empty() || name == "rgba" || name == "beauty" || name == "combined" || name == "c";
}

/// Moves the picture that is shown to the front.
void put_beauty_first(std::vector<StoredLayer>& layers) {
  const auto first = [&](auto condition) {
    return std::find_if(layers.begin(), layers.end(),
                        [&](const StoredLayer& s) { return condition(s.layer); });
  };
  // A grey layer with a name is depth or a mask.
  const auto has_rgb = [](const Layer& l) {
    const auto index = color_channels(l);
    return index && (*index)[0] != (*index)[1];
  };
  auto beauty = first([](const Layer& l) { return l.name.empty() && color_channels(l); });
  if (beauty == layers.end())
    beauty = first([&](const Layer& l) { return is_called_beauty(l.name) && has_rgb(l); });
  if (beauty == layers.end()) beauty = first(has_rgb);
  if (beauty == layers.end()) beauty = first([](const Layer& l) { return l.name.empty(); });
  if (beauty != layers.end()) std::rotate(layers.begin(), beauty, beauty + 1);
}

/// The layers of all flat parts that have pixels where the first part has them.
std::vector<StoredLayer> find_layers(const Imf::MultiPartInputFile& file) {
  std::vector<StoredLayer> layers;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    const std::string subsampled = subsampled_channel(header.channels());
    if (part == 0 && !subsampled.empty())
      throw std::runtime_error(fmt::format("channel '{}' is subsampled, which is not supported", subsampled));
    const bool deep = header.hasType() && Imf::isDeepData(header.type());
    if (part > 0 && (deep || !subsampled.empty() || header.dataWindow() != file.header(0).dataWindow()))
      continue;
    add_layers(header, part, file.parts() > 1 && header.hasName() ? header.name() : "", layers);
  }
  put_beauty_first(layers);
  return layers;
}

}  // namespace

Picture read_exr(const std::filesystem::path& path) {
  Imf::MultiPartInputFile file(path.c_str(), 0);
  const Imf::Header& header = file.header(0);
  const Imath::Box2i data = header.dataWindow();
  const Imath::Box2i display = header.displayWindow();

  Picture picture;
  picture.width = data.max.x - data.min.x + 1;
  picture.height = data.max.y - data.min.y + 1;
  picture.x0 = data.min.x - display.min.x;
  picture.y0 = data.min.y - display.min.y;
  picture.full_width = display.max.x - display.min.x + 1;
  picture.full_height = display.max.y - display.min.y + 1;
  std::vector<StoredLayer> layers = find_layers(file);

  const std::size_t width = static_cast<std::size_t>(picture.width);
  const std::size_t pixels = width * static_cast<std::size_t>(picture.height);
  std::size_t channels = 0;
  for (const StoredLayer& stored : layers) channels += stored.channels.size();
  if (channels == 0) throw std::runtime_error("it has no channels");
  check_claimed_size(picture.width, picture.height, static_cast<std::int64_t>(channels), path);

  std::vector<Imf::FrameBuffer> frames(static_cast<std::size_t>(file.parts()));
  for (StoredLayer& stored : layers) {
    const std::size_t count = stored.channels.size();
    stored.layer.values.resize(pixels * count);
    const std::size_t pixel_bytes = count * sizeof(float);
    // The address of the pixel (0, 0), to which the library adds the offset of the data window. A data window
    // may lie anywhere, so the address is an integer that may wrap, not a pointer.
    const std::uintptr_t origin = reinterpret_cast<std::uintptr_t>(stored.layer.values.data()) -
                                  static_cast<std::uintptr_t>(data.min.x) * pixel_bytes -
                                  static_cast<std::uintptr_t>(data.min.y) * pixel_bytes * width;
    for (std::size_t c = 0; c < count; ++c) {
      // NOLINTNEXTLINE(performance-no-int-to-ptr): see above
      char* const channel = reinterpret_cast<char*>(origin + c * sizeof(float));
      frames[static_cast<std::size_t>(stored.part)].insert(
          stored.channels[c], Imf::Slice(Imf::FLOAT, channel, pixel_bytes, pixel_bytes * width));
    }
  }
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::FrameBuffer& frame = frames[static_cast<std::size_t>(part)];
    if (frame.begin() == frame.end()) continue;
    try {
      Imf::InputPart input(file, part);
      input.setFrameBuffer(frame);
      input.readPixels(data.min.y, data.max.y);
    } catch (const std::exception&) {
      if (layers.front().part == part) throw;
      std::erase_if(layers, [part](const StoredLayer& stored) { return stored.part == part; });
    }
  }
  for (StoredLayer& stored : layers) picture.layers.push_back(std::move(stored.layer));

  constexpr std::string_view kPrefix = "gatelight:";
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& attributes = file.header(part);
    for (auto it = attributes.begin(); it != attributes.end(); ++it) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
      const std::string_view name = it.name();
      if (text == nullptr) continue;
      if (name.starts_with(kPrefix)) picture.metadata.emplace(name.substr(kPrefix.size()), text->value());
      if (name.starts_with(kCryptomattePrefix)) picture.attributes.emplace(name, text->value());
    }
  }
  return picture;
}

}  // namespace gatelight::renderer
