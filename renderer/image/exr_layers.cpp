#include "renderer/image/exr_layers.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/half.h"
#include "renderer/image/color_channels.h"
#include "renderer/image/cryptomatte.h"
#include "renderer/image/layer_names.h"

namespace gatelight::renderer {
namespace {

/// The sort key of a channel: colour and vector channels in their usual order, then all others.
int channel_rank(std::string_view channel) {
  constexpr std::string_view kOrder = "RGBAXYZ";
  const std::size_t at = channel.size() == 1 ? kOrder.find(channel) : std::string_view::npos;
  return at == std::string_view::npos ? static_cast<int>(kOrder.size()) : static_cast<int>(at);
}

/// The first subsampled channel; empty where there is none.
std::string subsampled_channel(const Imf::ChannelList& channels) {
  for (auto it = channels.begin(); it != channels.end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) return it.name();
  }
  return "";
}

/// Gives the channels their usual names, in the usual order. Where several would have the same one, they keep
/// their own.
void name_channels(StoredLayer& stored) {
  std::map<std::string, int> times;
  for (const std::string& own : stored.layer.channels) ++times[usual_channel(own)];
  std::vector<std::pair<std::string, std::string>> channels;  // and the full names
  for (std::size_t c = 0; c < stored.channels.size(); ++c) {
    const std::string &own = stored.layer.channels[c], usual = usual_channel(own);
    channels.emplace_back(times[usual] == 1 ? usual : own, stored.channels[c]);
  }
  std::stable_sort(channels.begin(), channels.end(), [](const auto& a, const auto& b) {
    return channel_rank(a.first) < channel_rank(b.first);
  });
  for (std::size_t c = 0; c < channels.size(); ++c)
    std::tie(stored.layer.channels[c], stored.channels[c]) = std::move(channels[c]);
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
    stored->channels.push_back(full);
  }
  for (StoredLayer& stored : own) {
    name_channels(stored);
    if (std::none_of(layers.begin(), layers.end(),
                     [&](const auto& s) { return s.layer.name == stored.layer.name; }))
      layers.push_back(std::move(stored));
  }
}

/// The kinds of names that Cryptomattes hold, by the header of a part.
void add_cryptomatte_kinds(const Imf::Header& header, Picture& names) {
  for (auto it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    if (text && std::string_view(it.name()).starts_with(kCryptomattePrefix))
      names.attributes.emplace(it.name(), text->value());
  }
}

/// Moves the picture that is shown to the front.
void put_beauty_first(std::vector<StoredLayer>& layers, const Picture& cryptomattes) {
  const auto first = [&](auto condition) {
    return std::find_if(layers.begin(), layers.end(),
                        [&](const StoredLayer& s) { return condition(s.layer); });
  };
  // A grey layer with a name is depth or a mask.
  const auto has_rgb = [](const Layer& l) {
    const auto index = color_channels(l);
    return index && (*index)[0] != (*index)[1];
  };
  const auto has_role = [](const Layer& l, LayerRole role) { return meaning_of(l.name).role == role; };
  auto shown = first([](const Layer& l) { return l.name.empty() && color_channels(l); });
  if (shown == layers.end())
    shown = first([&](const Layer& l) { return has_role(l, LayerRole::beauty) && has_rgb(l); });
  if (shown == layers.end())
    shown = first([&](const Layer& l) {
      return has_rgb(l) && !is_cryptomatte(cryptomattes, l.name) &&
             (has_role(l, LayerRole::noisy) || has_role(l, LayerRole::other));
    });
  if (shown == layers.end()) shown = first(has_rgb);
  if (shown == layers.end()) shown = first([](const Layer& l) { return l.name.empty(); });
  if (shown != layers.end()) std::rotate(layers.begin(), shown, shown + 1);
}

}  // namespace

std::vector<StoredLayer> find_layers(const Imf::MultiPartInputFile& file) {
  std::vector<StoredLayer> layers;
  Picture cryptomattes;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    add_cryptomatte_kinds(header, cryptomattes);
    const std::string subsampled = subsampled_channel(header.channels());
    if (part == 0 && !subsampled.empty())
      throw std::runtime_error(fmt::format("channel '{}' is subsampled, which is not supported", subsampled));
    const bool deep = header.hasType() && Imf::isDeepData(header.type());
    if (part > 0 && (deep || !subsampled.empty() || header.dataWindow() != file.header(0).dataWindow()))
      continue;
    add_layers(header, part, file.parts() > 1 && header.hasName() ? header.name() : "", layers);
  }
  put_beauty_first(layers, cryptomattes);
  return layers;
}

char* origin(const void* base, std::size_t pixel_bytes, std::size_t row_bytes, const Imath::Box2i& data) {
  const auto of = [](int offset) { return static_cast<std::uintptr_t>(offset); };
  // NOLINTNEXTLINE(performance-no-int-to-ptr): it may wrap
  return reinterpret_cast<char*>(reinterpret_cast<std::uintptr_t>(base) - of(data.min.x) * pixel_bytes -
                                 of(data.min.y) * row_bytes);
}

half to_half(float value) {
  if (value > kMaxHalf && value <= std::numeric_limits<float>::max()) return half(kMaxHalf);
  if (value < -kMaxHalf && value >= std::numeric_limits<float>::lowest()) return half(-kMaxHalf);
  return half(value);
}

}  // namespace gatelight::renderer
