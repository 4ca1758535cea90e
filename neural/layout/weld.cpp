
#include <fmt/format.h>

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "base/errors.h"
#include "base/random.h"
#include "neural/layout/surface_layout.h"

#include "base/parallel/loops.h"

namespace gatelight::neural {

namespace {

using Bits = std::array<std::uint32_t, 3>;

Bits position_bits(const Float3& p) {
  Bits bits;
  for (int c = 0; c < 3; ++c) {
    bits[c] = std::bit_cast<std::uint32_t>(p[c]);
    if (bits[c] == 0x80000000u) bits[c] = 0;  // -0
  }
  return bits;
}

std::uint64_t hash(const Bits& bits) {
  return mix_bits(mix_bits(std::uint64_t{bits[0]} << 32 | bits[1]) ^ bits[2]);
}

}  // namespace

std::vector<std::uint32_t> weld_vertices(std::span<const Float3> positions) {
  constexpr std::size_t kMax = std::size_t{1} << 31;
  if (positions.size() >= kMax)
    throw BadConfiguration(fmt::format("positions: {}, expected fewer than 2^31", positions.size()));
  // A slot holds the upper half of the hash and the smallest index of the position plus one. A position keeps
  // its slot and the smallest index wins, so the order of the threads does not matter.
  std::vector<std::atomic<std::uint64_t>> slots(std::bit_ceil(positions.size() + positions.size() / 2 + 1));
  const std::uint64_t mask = slots.size() - 1;
  std::vector<std::uint32_t> first(positions.size());
  for_each_range(positions.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) {
      const Bits bits = position_bits(positions[i]);
      const std::uint64_t key = hash(bits);
      const std::uint64_t tag = key & 0xffffffff00000000u;
      const std::uint64_t mine = tag | (i + 1);
      for (std::uint64_t at = key & mask;; at = (at + 1) & mask) {
        std::uint64_t there = slots[at].load(std::memory_order_relaxed);
        if (there == 0 && slots[at].compare_exchange_strong(there, mine, std::memory_order_relaxed))
          there = mine;
        if ((there & 0xffffffff00000000u) != tag ||
            position_bits(positions[(there & 0xffffffffu) - 1]) != bits)
          continue;
        while (mine < there && !slots[at].compare_exchange_weak(there, mine, std::memory_order_relaxed)) {
        }
        first[i] = static_cast<std::uint32_t>(at);
        break;
      }
    }
  });
  for_each_range(positions.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i)
      first[i] = static_cast<std::uint32_t>(slots[first[i]].load(std::memory_order_relaxed)) - 1;
  });
  return first;
}

}  // namespace gatelight::neural
