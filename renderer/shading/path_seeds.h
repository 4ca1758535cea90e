#pragma once
// Random numbers of a path that need no low discrepancy.

#include <cstdint>

#include "renderer/sampling/sampler.h"
#include "renderer/surface/ray.h"

namespace gatelight::renderer {

/// Random numbers for a path's decisions at a vertex, from its current seed.
inline float roulette_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x68bc21ebu));
}
inline float texture_level_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x2545f491u));
}
inline float shadow_roulette_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x1b873593u));
}
inline std::uint32_t shadow_seed(std::uint32_t seed) {
  return hash(seed ^ 0x5bd1e995u);
}
inline float boundary_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x7f4a7c15u));
}
inline float lobe_number(std::uint32_t seed) {
  return sampling::to_unit_float(hash(seed ^ 0x94d049bbu));
}
inline std::uint32_t next_seed(std::uint32_t seed) {
  return hash(seed + 0x9e3779b9u);
}

}  // namespace gatelight::renderer
