#include "scene/png_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace gatelight::scene {
namespace {

constexpr std::size_t kSignature = 8;

/// CRC-32 of the PNG specification (annex D), polynomial 0xedb88320, eight bytes at a time. Table k holds the
/// remainder of a byte that is followed by k more bytes.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables crc_tables() {
  CrcTables tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    tables[0][i] = c;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t i = 0; i < 256; ++i) {
      const std::uint32_t c = tables[k - 1][i];
      tables[k][i] = tables[0][c & 0xffu] ^ (c >> 8);
    }
  }
  return tables;
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  static constexpr CrcTables kTables = crc_tables();
  std::uint32_t c = 0xffffffffu;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    const std::uint8_t* p = bytes.data() + i;
    c = kTables[7][(c ^ p[0]) & 0xffu] ^ kTables[6][((c >> 8) ^ p[1]) & 0xffu] ^
        kTables[5][((c >> 16) ^ p[2]) & 0xffu] ^ kTables[4][(c >> 24) ^ p[3]] ^ kTables[3][p[4]] ^
        kTables[2][p[5]] ^ kTables[1][p[6]] ^ kTables[0][p[7]];
  }
  for (; i < bytes.size(); ++i) c = kTables[0][(c ^ bytes[i]) & 0xffu] ^ (c >> 8);
  return c ^ 0xffffffffu;
}

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24 | static_cast<std::uint32_t>(bytes[at + 1]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8 | static_cast<std::uint32_t>(bytes[at + 3]);
}

bool is_essential(std::string_view type) {
  constexpr std::array<std::string_view, 5> kEssential = {"IHDR", "PLTE", "tRNS", "IDAT", "IEND"};
  return std::find(kEssential.begin(), kEssential.end(), type) != kEssential.end();
}

}  // namespace

std::vector<std::uint8_t> essential_png(std::span<const std::uint8_t> file, std::string& problem) {
  std::vector<std::uint8_t> out;
  out.reserve(file.size());
  out.assign(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(std::min(kSignature, file.size())));
  bool has_data = false;
  for (std::size_t at = kSignature; at < file.size();) {
    if (file.size() - at < 12) break;
    const std::size_t length = read_u32(file, at);
    if (length > file.size() - at - 12) break;
    const std::span<const std::uint8_t> chunk = file.subspan(at, length + 12);
    const std::string_view type(reinterpret_cast<const char*>(chunk.data() + 4), 4);
    if (at == kSignature && (type != "IHDR" || length != 13)) break;
    if (is_essential(type)) {
      if (crc32(chunk.subspan(4, length + 4)) != read_u32(chunk, length + 8)) {
        problem = fmt::format("checksum of {} at byte {} is wrong", type, at);
        return {};
      }
      out.insert(out.end(), chunk.begin(), chunk.end());
      has_data |= type == "IDAT";
      if (type == "IEND" && has_data) return out;
    }
    at += chunk.size();
  }
  problem = "the PNG data is cut off or damaged";
  return {};
}

}  // namespace gatelight::scene
