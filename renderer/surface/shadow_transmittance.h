#pragma once
// The light that passes along a shadow ray: panes, unrefracted glass and the media between.

#include <cstdint>

#include "renderer/surface/coverage.h"
#include "renderer/surface/ray.h"

namespace gatelight::renderer {

/// A ray that meets more panes than this ends and counts as blocked.
inline constexpr int kMaxPanes = 64;

class ShadowTransmittance {
 public:
  std::uint32_t seed = 0;  ///< of the ray

  void start(const Ray& ray);

  /// The ray meets a surface, in any order and perhaps several times. False: it blocks the ray.
  bool pass(const Coverage& coverage, const Hit& hit);

  /// The light that remains after `distance`. A medium without an end in this distance absorbs all along it,
  /// but none of the light of a sky, as in path tracing.
  Color passed(const Coverage& coverage, float distance);

 private:
  /// The point where a ray enters or leaves glass with an inside. Not initialised: a ray has many.
  struct Boundary {
    float t, u, v;
    std::uint32_t instance, primitive, volume;
    bool front;

    Hit hit() const { return {t, u, v, instance, primitive}; }
  };

  Color through_boundaries(const Coverage& coverage, float distance);

  Vec3 origin_ = Vec3::Zero();
  Vec3 direction_ = Vec3::Zero();  ///< in world space; Embree's is in the space of the instance
  Color transmittance_{1.0f, 1.0f, 1.0f};
  /// Optical depth of the media along the ray: up to the ends that were met, minus that before their
  /// beginnings.
  Color depth_{0.0f, 0.0f, 0.0f};
  Color inside_{0.0f, 0.0f, 0.0f};           ///< absorption per metre of the media that have not ended
  bool absorbed_ = false;                    ///< whether one of the media absorbs
  const ScatteringMedium* start_ = nullptr;  ///< Ray::inside
  int panes_ = 0;
  int boundary_count_ = 0;          ///< of volumes of Media, among the panes
  std::uint64_t met_[kMaxPanes];    ///< the first `panes_` are set; spatial splits repeat a triangle
  Boundary boundaries_[kMaxPanes];  ///< the first `boundary_count_` are set, in any order
};

}  // namespace gatelight::renderer
