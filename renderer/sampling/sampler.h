#pragma once
// Random numbers that are a function of (seed, pixel, sample, dimension). A number does not depend on earlier
// numbers, on the thread or on the tile.
//
// Sobol points are scrambled and shuffled by hashing (Burley 2020, "Practical Hash-based Owen Scrambling").
// Every dimension uses the first two Sobol dimensions. It shuffles their indices, which keeps each aligned
// block of 2^k indices together, and scrambles each coordinate by its own nested uniform permutation. So the
// first 2^k samples of every pair are a (0,k,2)-net, and dimensions are independent.

#include <cstdint>

#include "base/math.h"
#include "renderer/settings/enums.h"

namespace gatelight::renderer {

namespace sampling {

inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/// The finaliser of MurmurHash3 with Stafford's thirteenth set of constants. It is a bijection in which every
/// input bit affects every output bit.
inline std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A permutation in which each bit depends only on itself and the lower bits (Laine and Karras 2011, with
/// Vegdahl's 2021 constants). Between two bit reversals it is Owen's nested uniform scramble.
inline std::uint32_t permute_upward(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// The second Sobol dimension of an index, with its bits reversed. Its generator matrix is Pascal's triangle
/// modulo 2. The entry (j, k) is 1 where the bits of k are a subset of those of j (Lucas' theorem). So the
/// product is a sum over supersets, one step for each of the five bits of a bit position.
inline std::uint32_t sobol_second_reversed(std::uint32_t index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

/// Converts the upper 24 bits to [0, 1): exact in a float, never 1.
inline float to_unit_float(std::uint32_t x) {
  return static_cast<float>(x >> 8) * 0x1p-24f;
}

}  // namespace sampling

/// The random numbers of one camera path. Trivially copyable, 12 bytes. Two samplers with the same key give
/// the same numbers.
class Sampler {
 public:
  Sampler() = default;
  /// Each pixel has its own sequence, also with SamplerKind::screen.
  Sampler(SamplerKind kind, std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t sample) {
    const bool independent = kind == SamplerKind::independent;
    kind_ = independent ? SamplerKind::independent : SamplerKind::sobol;
    index_ = independent ? sample : sampling::reverse_bits(sample);
    const std::uint64_t pixel = sampling::mix_bits((std::uint64_t{y} << 32) | x);
    key_ = static_cast<std::uint32_t>(sampling::mix_bits(pixel + seed) >> 32);
  }

  /// The sample of one sequence that has `spp` samples for each pixel, in the order of their Morton numbers
  /// `pixel` (Ahmed and Wonka 2020, "Screen-space blue-noise diffusion of Monte Carlo sampling error via
  /// hierarchical ordering of pixels"). Later samples have another sequence.
  static Sampler of_screen(std::uint32_t seed, std::uint32_t pixel, std::uint32_t spp, std::uint32_t sample) {
    const std::uint64_t sequence = sampling::mix_bits(~std::uint64_t{sample / spp});
    return from_parts(SamplerKind::sobol,
                      static_cast<std::uint32_t>(sampling::mix_bits(sequence + seed) >> 32),
                      sampling::reverse_bits(pixel * spp + sample % spp));
  }

  /// The same sampler from its parts.
  static Sampler from_parts(SamplerKind kind, std::uint32_t key, std::uint32_t index) {
    Sampler sampler;
    sampler.key_ = key;
    sampler.index_ = index;
    sampler.kind_ = kind;
    return sampler;
  }
  SamplerKind kind() const { return kind_; }
  std::uint32_t key() const { return key_; }
  std::uint32_t index() const { return index_; }

  /// Uniform in [0, 1). Use a dimension for one purpose, either as a number or as a pair.
  float get_1d(std::uint32_t dimension) const {
    using namespace sampling;
    if (kind_ == SamplerKind::independent) {
      return to_unit_float(static_cast<std::uint32_t>(independent_bits(dimension) >> 32));
    }
    const std::uint64_t hash = dimension_hash(dimension);
    const std::uint32_t index = reverse_bits(permute_upward(index_, static_cast<std::uint32_t>(hash)));
    return to_unit_float(reverse_bits(permute_upward(index, static_cast<std::uint32_t>(hash >> 32))));
  }
  Vec2 get_2d(std::uint32_t dimension) const {
    using namespace sampling;
    if (kind_ == SamplerKind::independent) {
      const std::uint64_t bits = independent_bits(dimension);
      return {to_unit_float(static_cast<std::uint32_t>(bits >> 32)),
              to_unit_float(static_cast<std::uint32_t>(bits))};
    }
    const std::uint64_t hash = dimension_hash(dimension);
    const auto second_hash = static_cast<std::uint32_t>((hash * 0xd1342543de82ef95u) >> 32);
    const std::uint32_t index = reverse_bits(permute_upward(index_, static_cast<std::uint32_t>(hash)));
    // The first Sobol dimension is the index itself with reversed bits.
    return {to_unit_float(reverse_bits(permute_upward(index, static_cast<std::uint32_t>(hash >> 32)))),
            to_unit_float(reverse_bits(permute_upward(sobol_second_reversed(index), second_hash)))};
  }

 private:
  std::uint64_t dimension_hash(std::uint32_t dimension) const {
    return sampling::mix_bits((std::uint64_t{key_} << 32) | dimension);
  }
  std::uint64_t independent_bits(std::uint32_t dimension) const {
    return sampling::mix_bits(dimension_hash(dimension) + std::uint64_t{index_} * 0x9e3779b97f4a7c15u);
  }

  std::uint32_t key_ = 0;
  std::uint32_t index_ = 0;                ///< number of the sample; for Sobol points with reversed bits
  SamplerKind kind_ = SamplerKind::sobol;  ///< sobol or independent
};

/// The seed of a camera ray, for alpha_number(): over the samples of a pixel the numbers of each surface are
/// as even as Sobol points.
inline std::uint32_t alpha_seed(const Sampler& sampler) {
  const std::uint32_t sequence = sampler.key() + (sampler.index() & 0xffffu) * 0x9e3779b9u;
  return (sequence & 0xffff0000u) | sampler.index() >> 16;
}

/// Uniform in [0, 1), for the decision whether a ray with this seed meets a blended surface or passes it.
/// Independent for different surfaces. Every seed is as good as any other.
inline float alpha_number(std::uint32_t seed, std::uint32_t surface) {
  const auto key =
      static_cast<std::uint32_t>(sampling::mix_bits((std::uint64_t{surface} << 32) | seed >> 16));
  return Sampler::from_parts(SamplerKind::sobol, key, seed << 16).get_1d(0);
}

}  // namespace gatelight::renderer
