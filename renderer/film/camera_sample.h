#pragma once
// The input and output of an integrator, one of each for a camera path. Integrators work on batches, so that
// rays are traced in packets and cache queries run in bulk.

#include <cstdint>

#include "renderer/film/camera.h"
#include "renderer/sampling/sampler.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

struct CameraSample {
  CameraRay camera_ray;
  Sampler sampler;
  std::uint32_t seed = 0;  ///< a hash of (seed, pixel, sample), for decisions that need no low discrepancy
  /// A light sample that adds less radiance than this is traced by Russian roulette. 0: all are traced.
  float contribution_threshold = 0.0f;
  MediumStack around;  ///< the volumes that the ray starts in

  /// The camera's ray.
  Ray ray() const {
    Ray ray = camera_ray.ray;
    ray.seed = sampler.kind() == SamplerKind::sobol ? alpha_seed(sampler) : seed;
    return ray;
  }
};

/// The first surface on the path that is neither a mirror nor clear, for the denoiser: a primary hit on a
/// mirror or glass does not describe the picture. If there is none, it is the last surface on the path.
struct GuideSurface {
  bool hit = false;
  std::int32_t surface = -1;       ///< its number on the path
  Color tint{1.0f, 1.0f, 1.0f};    ///< of the surfaces before it
  Color albedo{0.0f, 0.0f, 0.0f};  ///< times the tint
  Vec3 normal = Vec3::Zero();
};

/// The surface at the primary hit, for the output variables.
struct FirstHit {
  bool hit = false;
  float alpha = 1.0f;  ///< 1 minus the visible share of the background
  Color albedo{0.0f, 0.0f, 0.0f};
  Vec3 normal = Vec3::Zero();
  Vec3 position = Vec3::Zero();
  float depth = 0.0f;  ///< in metres from the eye along the ray
  std::uint32_t instance = kNoInstance;
  std::uint32_t primitive = 0;
  GuideSurface guide;
  bool guided = false;                     ///< cache_radiance is set
  Color cache_radiance{0.0f, 0.0f, 0.0f};  ///< of the path, hit or not, computed only from the cache
  // These come from the first cache query of the path.
  bool queried = false;
  Color answer{0.0f, 0.0f, 0.0f};
  Color node{0.0f, 0.0f, 0.0f};
  float error = 0.0f;
  float training_count = 0.0f;
  float resolution = 0.0f;
};

/// The position is in the file's coordinates. `origin` is the scene's origin.
inline FirstHit first_hit(const Hit& hit, const Surface& surface, const Vec3& origin) {
  FirstHit first;
  first.hit = true;
  first.albedo = surface.material.base_color;
  first.normal = surface.shading_normal;
  first.position = origin + surface.position;
  first.depth = hit.t;
  first.instance = hit.instance;
  first.primitive = hit.primitive;
  first.guide = {true, 0, Color::Ones(), first.albedo, first.normal};
  return first;
}

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
