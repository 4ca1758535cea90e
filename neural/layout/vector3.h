#pragma once
// Double-precision vectors and the affine transforms of instances.

#include <array>
#include <cmath>
#include <cstdint>

#include "neural/layout/surface_layout.h"

namespace gatelight::neural {

using Double3 = std::array<double, 3>;

inline Double3 operator+(const Double3& a, const Double3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Double3 operator-(const Double3& a, const Double3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Double3& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

struct Transform {
  std::array<Double3, 4> columns;
};

inline Transform to_transform(const std::array<float, 12>& m) {
  Transform result;
  for (int c = 0; c < 4; ++c) result.columns[c] = {m[3 * c], m[3 * c + 1], m[3 * c + 2]};
  return result;
}

/// columns[0] v0 + columns[1] v1 + columns[2] v2
inline Double3 transform_vector(const Transform& m, const Double3& v) {
  Double3 result;
  for (int r = 0; r < 3; ++r)
    result[r] = m.columns[0][r] * v[0] + m.columns[1][r] * v[1] + m.columns[2][r] * v[2];
  return result;
}

inline Double3 transform_point(const Transform& m, const Double3& p) {
  return transform_vector(m, p) + m.columns[3];
}

/// The matrix that transforms area vectors: (M a) x (M b) = cofactors(M) (a x b), for any M.
inline Transform cofactors(const Transform& m) {
  return {{cross(m.columns[1], m.columns[2]), cross(m.columns[2], m.columns[0]),
           cross(m.columns[0], m.columns[1]), Double3{0, 0, 0}}};
}

inline Double3 to_double(const Float3& p) {
  return {p[0], p[1], p[2]};
}

/// A vector of twice the triangle's area along its normal (right-hand rule over the corners), object space.
inline Double3 area_vector(const SurfaceMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Double3 origin = to_double(mesh.positions[triangle[0]]);
  return cross(to_double(mesh.positions[triangle[1]]) - origin,
               to_double(mesh.positions[triangle[2]]) - origin);
}

}  // namespace gatelight::neural
