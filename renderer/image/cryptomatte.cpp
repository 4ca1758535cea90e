#include "renderer/image/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <set>
#include <utility>

#include "renderer/image/murmur_hash.h"

namespace gatelight::renderer {
namespace {

std::string layer_name(const std::string& kind, std::size_t number) {
  return fmt::format("{}{:02}", kind, number);
}

std::string hexadecimal(std::uint32_t id) {
  return fmt::format("{:08x}", id);
}

/// As a string of JSON.
std::string json_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

std::string manifest(std::span<const std::string> names) {
  std::string text;
  for (const std::string& name : std::set<std::string>(names.begin(), names.end())) {
    text += text.empty() ? "{" : ",";
    text += json_string(name) + ":\"" + hexadecimal(cryptomatte_id(name)) + "\"";
  }
  return text.empty() ? "{}" : text + "}";
}

}  // namespace

std::uint32_t cryptomatte_id(std::string_view name) {
  const std::uint32_t hash = murmur_hash(name);
  const std::uint32_t exponent = hash >> 23 & 255u;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

std::size_t add_kind(Cryptomattes& mattes, const std::string& kind, std::span<const std::string> names,
                     std::size_t pixels) {
  const std::size_t first = mattes.layers.size();
  for (std::size_t i = 0; i < kCryptomatteLayers; ++i) {
    mattes.layers.push_back({.name = layer_name(kind, i),
                             .channels = {"R", "G", "B", "A"},
                             .values = std::vector<float>(4 * pixels, 0.0f),
                             .full_precision = true});
  }
  // Seven digits, so that no entry's name is longer than the 31 characters that old readers take.
  const std::string key =
      fmt::format("{}{}/", kCryptomattePrefix, hexadecimal(cryptomatte_id(kind)).substr(0, 7));
  mattes.attributes[key + "name"] = kind;
  mattes.attributes[key + "hash"] = "MurmurHash3_32";
  mattes.attributes[key + "conversion"] = "uint32_to_float32";
  mattes.attributes[key + "manifest"] = manifest(names);
  return first;
}

void set_pixel(Cryptomattes& mattes, std::size_t first, std::size_t pixel, std::span<const IdCoverage> ids) {
  for (std::size_t rank = 0; rank < std::min(ids.size(), kCryptomatteRanks); ++rank) {
    float* values = &mattes.layers[first + rank / 2].values[4 * pixel + 2 * (rank % 2)];
    values[0] = std::bit_cast<float>(ids[rank].id);
    values[1] = ids[rank].coverage;
  }
}

void add_cryptomattes(Picture& picture, Cryptomattes mattes) {
  picture.layers.insert(picture.layers.end(), std::move_iterator(mattes.layers.begin()),
                        std::move_iterator(mattes.layers.end()));
  picture.attributes.merge(mattes.attributes);
}

bool is_cryptomatte(const Picture& picture, const std::string& layer) {
  return std::any_of(picture.attributes.begin(), picture.attributes.end(), [&](const auto& entry) {
    const auto& [key, kind] = entry;
    return key.starts_with(kCryptomattePrefix) && key.ends_with("/name") && layer.size() == kind.size() + 2 &&
           layer.starts_with(kind);
  });
}

}  // namespace gatelight::renderer
