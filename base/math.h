#pragma once
// The vector types of the whole program. The world is right-handed, y is up, the unit is the metre; matrices
// are column-major.
//
// Eigen's expressions hold references to their operands. Declare a stored result with its type, never with
// `auto`.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <limits>

namespace gatelight {

using Vec2 = Eigen::Vector2f;
using Vec3 = Eigen::Vector3f;
using Vec4 = Eigen::Vector4f;

/// Linear Rec. 709 RGB. It is an array, so products are component-wise and it cannot be confused with a
/// direction.
using Color = Eigen::Array3f;

/// 3x4, column-major, 48 bytes: the layout of Embree's RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR.
using Affine = Eigen::AffineCompact3f;

using Box = Eigen::AlignedBox3f;

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 1.0f / kPi;

/// Luminance of linear Rec. 709.
inline float luminance(const Color& c) {
  return 0.2126f * c.x() + 0.7152f * c.y() + 0.0722f * c.z();
}

/// A unit vector perpendicular to the unit vector n.
inline Vec3 any_perpendicular(const Vec3& n) {
  const Vec3 axis = std::abs(n.x()) < 0.5f ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY());
  return (axis - n * n.dot(axis)).normalized();
}

/// Normal matrix of an affine transform: the inverse transpose times |determinant|, which exists for singular
/// transforms too. The transformed normal is not normalised. A mirroring transform keeps the side of a
/// normal: outside stays outside.
inline Eigen::Matrix3f normal_matrix(const Affine& transform) {
  const Eigen::Matrix3f m = transform.linear();
  Eigen::Matrix3f cofactor;
  cofactor.col(0) = m.col(1).cross(m.col(2));
  cofactor.col(1) = m.col(2).cross(m.col(0));
  cofactor.col(2) = m.col(0).cross(m.col(1));
  return m.determinant() < 0.0f ? Eigen::Matrix3f(-cofactor) : cofactor;
}

}  // namespace gatelight
