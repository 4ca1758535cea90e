#pragma once
// Counter-based random numbers: a function of a key and a counter, equal for any order and on any machine.

#include <cstdint>

namespace gatelight {

/// A bijective mix of 64 bits (the finaliser of SplitMix64: Steele, Lea, Flood 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A uniform number in [0,1) with 24 random bits.
constexpr float uniform_float(std::uint64_t key, std::uint64_t counter) {
  return static_cast<float>(mix_bits(mix_bits(key) ^ counter) >> 40) * 0x1p-24f;
}

}  // namespace gatelight
