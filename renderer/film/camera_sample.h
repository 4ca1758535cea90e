#pragma once
// What goes into an integrator and what comes out of it: one camera path each. Integrators work on batches,
// so that rays travel in packets and, later, so that a cache can be asked in bulk.

#include <cstdint>

#include "renderer/film/camera.h"
#include "renderer/sampling/sampler.h"
#include "renderer/surface/ray.h"

namespace gatelight::renderer {

struct CameraSample {
  CameraRay camera_ray;
  Sampler sampler;
  std::uint32_t seed = 0;  ///< hash of (seed, pixel, sample), for decisions that need no low discrepancy

  /// The camera's ray, which decides by the sample's seed.
  Ray ray() const {
    Ray ray = camera_ray.ray;
    ray.seed = seed;
    return ray;
  }
};

/// The surface at the primary hit, for the arbitrary output variables.
struct FirstHit {
  bool hit = false;
  Color albedo{0.0f, 0.0f, 0.0f};
  Vec3 normal = Vec3::Zero();
  Vec3 position = Vec3::Zero();
  float depth = 0.0f;  ///< metres from the eye along the ray
  std::uint32_t instance = kNoInstance;
  std::uint32_t primitive = 0;
  // Of the cache, where it was first asked.
  bool asked = false;
  Color answer{0.0f, 0.0f, 0.0f};
  Color node{0.0f, 0.0f, 0.0f};
  float error = 0.0f;
  float training_count = 0.0f;
  float resolution = 0.0f;
};

struct SampleResult {
  Color radiance{0.0f, 0.0f, 0.0f};
};

/// Dimensions of the sampler. The film takes the first pair, every vertex of the path four dimensions after
/// it.
namespace dimension {
inline constexpr std::uint32_t kFilm = 0;
inline constexpr std::uint32_t kFirstVertex = 1;
inline constexpr std::uint32_t kPerVertex = 4;
inline constexpr std::uint32_t kBsdfLobe = 0;
inline constexpr std::uint32_t kBsdfDirection = 1;
inline constexpr std::uint32_t kLightChoice = 2;
inline constexpr std::uint32_t kLightPoint = 3;
}  // namespace dimension

}  // namespace gatelight::renderer
