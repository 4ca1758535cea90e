#pragma once
// Bounds how far rounding moves a point on a triangle.

#include <Eigen/SVD>

#include <algorithm>

#include "scene/scene.h"

namespace gatelight::renderer {

/// The rounding of an instance's transform; none for a mesh in world space.
struct PlacementRounding {
  float translation = 0.0f;  ///< largest coordinate of the transform's translation
  float condition = 1.0f;    ///< of the transform: how much it amplifies the error of an intersection

  PlacementRounding() = default;
  /// Of all states of an open shutter.
  PlacementRounding(const scene::Scene& scene, std::size_t instance) {
    const scene::Instance& placed = scene.instances[instance];
    if (placed.baked) return;
    *this = PlacementRounding(placed.transform);
    if (!scene.shutter.instances) return;
    for (const Affine& transform : scene.shutter.transforms[instance]) extend(PlacementRounding(transform));
  }
  explicit PlacementRounding(const Affine& transform) {
    translation = transform.translation().cwiseAbs().maxCoeff();
    const Eigen::Matrix3f linear = transform.linear();
    const Vec3 singular = linear.jacobiSvd().singularValues();
    condition = singular.z() > 0.0f ? std::min(singular.x() / singular.z(), 1e4f) : 1.0f;
  }

  /// Bounds the rounding of both.
  void extend(const PlacementRounding& other) {
    translation = std::max(translation, other.translation);
    condition = std::max(condition, other.condition);
  }
};

/// A bound in metres, along the normal, for the error of a point on the triangle and of an intersection with
/// it. Rounding in the corners, the interpolation and the intersection test gives some units in the last
/// place of the largest coordinate. 16 units were enough from 1e-3 to 1e6 metres
/// (tests/renderer/surface/accel_test.cpp).
inline float rounding_offset(const Vec3& p0, const Vec3& p1, const Vec3& p2,
                             const PlacementRounding& placement) {
  constexpr float kUlps = 16.0f * 0x1p-23f;
  const float largest =
      std::max({p0.cwiseAbs().maxCoeff(), p1.cwiseAbs().maxCoeff(), p2.cwiseAbs().maxCoeff()});
  return kUlps * placement.condition * (largest + placement.translation);
}

}  // namespace gatelight::renderer
