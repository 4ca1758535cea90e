#pragma once
// Right checksums for the chunks of a mutated PNG, so that more than its first mutation is decoded.

#include <cstdint>
#include <vector>

namespace gatelight::fuzz {

inline void repair_png_checksums(std::vector<std::uint8_t>& file) {
  const auto u32 = [&](std::size_t at) {
    return std::uint32_t{file[at]} << 24 | std::uint32_t{file[at + 1]} << 16 |
           std::uint32_t{file[at + 2]} << 8 | std::uint32_t{file[at + 3]};
  };
  for (std::size_t at = 8; file.size() > at && file.size() - at >= 12;) {
    const std::size_t length = u32(at);
    if (length > file.size() - at - 12) return;
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = at + 4; i < at + 8 + length; ++i) {
      crc ^= file[i];
      for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
    crc ^= 0xffffffffu;
    for (std::size_t i = 0; i < 4; ++i)
      file[at + 8 + length + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    at += length + 12;
  }
}

}  // namespace gatelight::fuzz
