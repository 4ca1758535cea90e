#pragma once
// The random numbers of the lanes: the SIMD version of renderer/sampling/sampler.h, with the same bits. Part
// of kernel_table.cpp.

#include "base/simd/vectors.h"
#include "renderer/settings/enums.h"
#include "renderer/shading/kernel_math.h"

namespace {

/// Lanes of 64-bit numbers, in halves.
struct Int64 {
  Int high, low;
};
GATELIGHT_INLINE Int64 multiply(Int64 a, uint64_t b) {
  const auto high = static_cast<uint32_t>(b >> 32), low = static_cast<uint32_t>(b);
  return {multiply_high(a.low, low) + a.low * high + a.high * low, a.low * low};
}
template <int kBits>
GATELIGHT_INLINE Int64 xor_shifted(Int64 a) {
  return {a.high ^ (a.high >> kBits), a.low ^ (a.low >> kBits | a.high << (32 - kBits))};
}
GATELIGHT_INLINE Int64 mix_bits(Int64 x) {
  x = multiply(xor_shifted<30>(x), 0xbf58476d1ce4e5b9u);
  x = multiply(xor_shifted<27>(x), 0x94d049bb133111ebu);
  return xor_shifted<31>(x);
}
GATELIGHT_INLINE Int reverse_bits(Int x) {
  x = x >> 24 | ((x >> 8) & 0xff00u) | ((x << 8) & 0xff0000u) | x << 24;
  x = ((x >> 4) & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = ((x >> 2) & 0x33333333u) | (x & 0x33333333u) << 2;
  return ((x >> 1) & 0x55555555u) | (x & 0x55555555u) << 1;
}
GATELIGHT_INLINE Int permute_upward(Int x, Int seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
GATELIGHT_INLINE Int sobol_second_reversed(Int index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

struct Float2 {
  Float x, y;
};

struct LaneSampler {
  gatelight::renderer::SamplerKind kind;
  Int key, index;

  GATELIGHT_INLINE Float get_1d(Int dimension) const {
    const Int64 hashed = mix_bits({key, dimension});
    if (kind == gatelight::renderer::SamplerKind::independent) return to_unit_float(independent(hashed).high);
    const Int order = reverse_bits(permute_upward(index, hashed.low));
    return to_unit_float(reverse_bits(permute_upward(order, hashed.high)));
  }
  GATELIGHT_INLINE Float2 get_2d(Int dimension) const {
    const Int64 hashed = mix_bits({key, dimension});
    if (kind == gatelight::renderer::SamplerKind::independent) {
      const Int64 bits = independent(hashed);
      return {to_unit_float(bits.high), to_unit_float(bits.low)};
    }
    const Int order = reverse_bits(permute_upward(index, hashed.low));
    const Int second = multiply(hashed, 0xd1342543de82ef95u).high;
    return {to_unit_float(reverse_bits(permute_upward(order, hashed.high))),
            to_unit_float(reverse_bits(permute_upward(sobol_second_reversed(order), second)))};
  }

 private:
  GATELIGHT_INLINE Int64 independent(Int64 hashed) const {
    const Int64 step = multiply({Int(0u), index}, 0x9e3779b97f4a7c15u);
    const Int low = hashed.low + step.low;
    const Int carry = words_of(low < step.low) & 1u;
    return mix_bits({hashed.high + step.high + carry, low});
  }
};

}  // namespace
