#pragma once
// A .glb whose header and chunk lengths are right, so that a mutation of its parts is not refused
// there.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace gatelight::tests {

inline void add_u32(std::vector<std::uint8_t>& out, std::size_t value) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline void add_chunk(std::vector<std::uint8_t>& out, std::uint32_t type,
                      std::span<const std::uint8_t> content) {
  add_u32(out, content.size());
  add_u32(out, type);
  out.insert(out.end(), content.begin(), content.end());
}

/// JSON up to the first zero byte, the binary chunk behind it; without one there is no such chunk.
inline std::vector<std::uint8_t> made_glb(std::span<const std::uint8_t> bytes) {
  const auto zero = std::find(bytes.begin(), bytes.end(), std::uint8_t{0});
  const std::span json(bytes.begin(), zero);
  std::vector<std::uint8_t> chunks;
  add_chunk(chunks, 0x4e4f534a, json);
  if (zero != bytes.end()) add_chunk(chunks, 0x004e4942, std::span(zero + 1, bytes.end()));
  std::vector<std::uint8_t> file;
  add_u32(file, 0x46546c67);
  add_u32(file, 2);
  add_u32(file, 12 + chunks.size());
  file.insert(file.end(), chunks.begin(), chunks.end());
  return file;
}

}  // namespace gatelight::tests
