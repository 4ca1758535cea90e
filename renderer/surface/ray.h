#pragma once
// Rays and hits of the integrators. renderer/surface/accel.h converts them to Embree's packets.

#include <cstdint>

#include "base/math.h"

namespace gatelight::renderer {

inline constexpr std::uint32_t kNoInstance = ~0u;

/// The seed of a ray that meets all blended surfaces.
inline constexpr std::uint32_t kMeetsAll = ~0u;

struct ScatteringMedium;

struct Ray {
  Vec3 origin = Vec3::Zero();
  float t_max = kInfinity;
  Vec3 direction{0.0f, 0.0f, -1.0f};  ///< unit
  std::uint32_t seed = 0;             ///< for the stochastic alpha test; equal seeds meet equal surfaces
  float time = 0.5f;                  ///< of the shutter (scene/shutter.h)
  std::uint32_t mask = ~0u;           ///< of the instances that it meets (ray_masks.h)
  /// What a shadow ray starts in, where that counts and does not end at a surface; else null.
  const ScatteringMedium* inside = nullptr;
};

struct Hit {
  float t = kInfinity;
  float u = 0.0f;  ///< barycentric weight of the triangle's second corner
  float v = 0.0f;  ///< barycentric weight of the triangle's third corner
  std::uint32_t instance = kNoInstance;
  std::uint32_t primitive = 0;
  float time = 0.5f;  ///< of the ray

  explicit operator bool() const { return instance != kNoInstance; }
};

/// An integer hash with full avalanche: "lowbias32" by C. Wellons.
inline std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

}  // namespace gatelight::renderer
