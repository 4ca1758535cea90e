#include "renderer/image/murmur_hash.h"

#include <bit>

namespace gatelight::renderer {
namespace {

/// Up to four bytes, the first one lowest.
std::uint32_t word_of(std::string_view bytes) {
  std::uint32_t word = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[i]);
  return word;
}

std::uint32_t scrambled(std::uint32_t word) {
  return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u;
}

}  // namespace

std::uint32_t murmur_hash(std::string_view text) {
  std::uint32_t h = 0;
  const std::size_t whole = text.size() / 4 * 4;
  for (std::size_t i = 0; i < whole; i += 4)
    h = std::rotl(h ^ scrambled(word_of(text.substr(i, 4))), 13) * 5 + 0xe6546b64u;
  h ^= scrambled(word_of(text.substr(whole)));
  h ^= static_cast<std::uint32_t>(text.size());
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

}  // namespace gatelight::renderer
