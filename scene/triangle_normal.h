#pragma once

#include <cmath>

#include "base/math.h"

namespace gatelight::scene {

/// The unit normal for counter-clockwise winding, and twice the area. Slivers, and areas whose squares under-
/// or overflow in single precision, are computed in double. Both results are zero if the corners lie on a
/// line.
inline Vec3 triangle_normal(const Vec3& p0, const Vec3& p1, const Vec3& p2, float& twice_area) {
  const Vec3 edge1 = p1 - p0;
  const Vec3 edge2 = p2 - p0;
  const Vec3 cross = edge1.cross(edge2);
  const float squared = cross.squaredNorm();
  // The sine of the angle at p0 is above a thousandth.
  if (squared > 1e-6f * edge1.squaredNorm() * edge2.squaredNorm() && squared > 1e-30f && squared < 1e30f) {
    twice_area = std::sqrt(squared);
    return cross / twice_area;
  }
  const Eigen::Vector3d corner = p0.cast<double>();
  const Eigen::Vector3d wide = (p1.cast<double>() - corner).cross(p2.cast<double>() - corner);
  const double length = wide.norm();
  twice_area = static_cast<float>(length);
  return length > 0.0 ? Vec3((wide / length).cast<float>()) : Vec3(Vec3::Zero());
}

}  // namespace gatelight::scene
