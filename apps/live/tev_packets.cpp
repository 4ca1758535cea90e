#include "apps/live/tev_packets.h"

#include <bit>
#include <cstdint>

namespace gatelight::apps {
namespace {

enum class Operation : std::uint8_t { create_image = 4, update_image_3 = 6 };

/// Little-endian values after each other, behind their count of bytes.
class Packet {
 public:
  explicit Packet(Operation operation) {
    add<std::uint32_t>(0);
    add(static_cast<std::uint8_t>(operation));
  }

  template <class Integer>
  void add(Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> 8 * i & 0xff));
  }

  /// Ends with a zero, so that it cannot hold one.
  void add_text(const std::string& text) {
    bytes_.append(text.c_str());
    bytes_.push_back('\0');
  }

  void add_floats(const float* values, std::size_t count) {
    bytes_.reserve(bytes_.size() + sizeof(float) * count);
    for (std::size_t i = 0; i < count; ++i) add(std::bit_cast<std::uint32_t>(values[i]));
  }

  std::string take() {
    const std::string rest = bytes_.substr(sizeof(std::uint32_t));
    const auto size = static_cast<std::uint32_t>(bytes_.size());
    bytes_.clear();
    add(size);
    return bytes_ + rest;
  }

 private:
  std::string bytes_;
};

}  // namespace

std::string tev_channel(const renderer::Layer& layer, std::size_t channel) {
  return layer.name.empty() ? layer.channels[channel] : layer.name + "." + layer.channels[channel];
}

std::string tev_create_image(const std::string& name, const renderer::Picture& picture) {
  Packet packet(Operation::create_image);
  packet.add<std::uint8_t>(1);  // select it
  packet.add_text(name);
  packet.add<std::int32_t>(picture.full_width > 0 ? picture.full_width : picture.width);
  packet.add<std::int32_t>(picture.full_height > 0 ? picture.full_height : picture.height);
  std::int32_t count = 0;
  for (const renderer::Layer& layer : picture.layers)
    count += static_cast<std::int32_t>(layer.channels.size());
  packet.add(count);
  for (const renderer::Layer& layer : picture.layers) {
    for (std::size_t c = 0; c < layer.channels.size(); ++c) packet.add_text(tev_channel(layer, c));
  }
  return packet.take();
}

std::string tev_update_image(const std::string& name, const renderer::Picture& picture,
                             const renderer::Layer& layer, int begin, int end) {
  const std::size_t channels = layer.channels.size();
  Packet packet(Operation::update_image_3);
  packet.add<std::uint8_t>(0);  // the selection stays
  packet.add_text(name);
  packet.add(static_cast<std::int32_t>(channels));
  for (std::size_t c = 0; c < channels; ++c) packet.add_text(tev_channel(layer, c));
  packet.add<std::int32_t>(picture.x0);
  packet.add<std::int32_t>(picture.y0 + begin);
  packet.add<std::int32_t>(picture.width);
  packet.add<std::int32_t>(end - begin);
  for (std::size_t c = 0; c < channels; ++c) packet.add(static_cast<std::int64_t>(c));         // offsets
  for (std::size_t c = 0; c < channels; ++c) packet.add(static_cast<std::int64_t>(channels));  // strides
  const std::size_t row = static_cast<std::size_t>(picture.width) * channels;
  packet.add_floats(layer.values.data() + static_cast<std::size_t>(begin) * row,
                    static_cast<std::size_t>(end - begin) * row);
  return packet.take();
}

}  // namespace gatelight::apps
