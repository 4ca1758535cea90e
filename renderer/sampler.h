#pragma once
// Random numbers keyed by (seed, pixel, sample, dimension): a number never depends on what was drawn before
// it, on the thread or on the tile.

#include <cstdint>

#include "scene/math.h"

namespace gatelight::renderer {

using scene::Vec2;

enum class SamplerKind : std::uint8_t {
  sobol,  ///< Owen-scrambled Sobol points, padded: every pair of dimensions is a (0,2)-sequence of its own
  independent,  ///< a hash of the key
};

/// The samples of one camera path. Trivially copyable, 12 bytes; two samplers with the same key give the same
/// numbers.
class Sampler {
 public:
  Sampler() = default;
  Sampler(SamplerKind kind, std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t sample);

  /// Uniform in [0, 1). A dimension is used for one purpose, either as a number or as a pair.
  float get_1d(std::uint32_t dimension) const;
  Vec2 get_2d(std::uint32_t dimension) const;

 private:
  std::uint32_t key_ = 0;
  std::uint32_t index_ = 0;
  SamplerKind kind_ = SamplerKind::sobol;
};

}  // namespace gatelight::renderer
