#pragma once
// Coarse meshes with vertex normals: light that grazes the round surface that the normals describe is hidden
// by the flat triangles, which shows as black staircases (the shadow terminator). A point is therefore moved
// onto a round surface, and light may reach it from all sides of that surface (Hanika 2021, "Hacking the
// Shadow Terminator", Ray Tracing Gems II, chapter 4).

#include <algorithm>

#include "base/math.h"

namespace gatelight::renderer {

/// The offset in metres from a point of a flat triangle to the round surface: the mean of the point's
/// projections on the planes through the vertices, perpendicular to their normals, as far as the point lies
/// below them. Zero where the surface is flat or hollow. `p` and `n` are the corners and their unit normals
/// on the side of the viewer, `weights` the point's weights of the corners.
inline Vec3 terminator_raise(const Vec3& point, const Vec3 (&p)[3], const Vec3 (&n)[3], const Vec3& weights) {
  Vec3 raise = Vec3::Zero();
  for (int corner = 0; corner < 3; ++corner) {
    const float below = std::max(0.0f, n[corner].dot(p[corner] - point));
    raise += n[corner] * (weights[corner] * below);
  }
  return raise;
}

}  // namespace gatelight::renderer
