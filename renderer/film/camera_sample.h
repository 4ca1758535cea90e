#pragma once
// The input and output of an integrator, one of each for a camera path. Integrators work on batches, so that
// rays are traced in packets and cache queries run in bulk.

#include <cstdint>

#include "renderer/film/camera.h"
#include "renderer/film/first_hit.h"
#include "renderer/sampling/sampler.h"

namespace gatelight::renderer {

struct CameraSample {
  CameraRay camera_ray;
  Sampler sampler;
  std::uint32_t seed = 0;  ///< a hash of (seed, pixel, sample), for decisions that need no low discrepancy
  /// A light sample that adds less radiance than this is traced by Russian roulette. 0: all are traced.
  float contribution_threshold = 0.0f;
  StartMedium start;  ///< what the ray starts in

  /// The camera's ray.
  Ray ray() const {
    Ray ray = camera_ray.ray;
    ray.seed = sampler.kind() == SamplerKind::sobol ? alpha_seed(sampler) : seed;
    return ray;
  }
};

struct SampleResult {
  Color radiance{0.0f, 0.0f, 0.0f};
};

/// Dimensions of the sampler. The film uses the first one, then every vertex of the path uses four.
namespace dimension {
inline constexpr std::uint32_t kFilm = 0;
inline constexpr std::uint32_t kLens = 0x80000000u;    ///< beyond those of all vertices
inline constexpr std::uint32_t kMedium = 0x40000000u;  ///< beyond those of all vertices
inline constexpr std::uint32_t kWavelength = kLens + 1;
inline constexpr std::uint32_t kTime = kLens + 2;
inline constexpr std::uint32_t kFirstVertex = 1;
inline constexpr std::uint32_t kPerVertex = 4;
inline constexpr std::uint32_t kBsdfLobe = 0;
inline constexpr std::uint32_t kBsdfDirection = 1;
inline constexpr std::uint32_t kLightChoice = 2;
inline constexpr std::uint32_t kLightPoint = 3;
}  // namespace dimension

/// The camera's ray through a point of the picture. Points of a lens and times of an open shutter are sampled
/// where there are any.
inline CameraRay camera_ray(const Camera& camera, float x, float y, const Sampler& sampler) {
  const Vec2 lens = camera.has_lens() ? sampler.get_2d(dimension::kLens) : Vec2(Vec2::Zero());
  return camera.has_shutter() ? camera.ray(x, y, lens, sampler.get_1d(dimension::kTime))
                              : camera.ray(x, y, lens);
}

}  // namespace gatelight::renderer
