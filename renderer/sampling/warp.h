#pragma once
// Maps from the unit square to the shapes that light transport integrates over, with their pdfs. The maps are
// continuous or nearly so, which keeps stratified samples stratified. Hemispheres have the axis +z.

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace gatelight::renderer {

inline constexpr float kTwoPi = 2.0f * kPi;
inline constexpr float kInvTwoPi = 0.5f * kInvPi;
inline constexpr float kInvFourPi = 0.25f * kInvPi;

/// A right-handed orthonormal basis around a unit normal.
struct Basis {
  Vec3 tangent;
  Vec3 bitangent;
  Vec3 normal;

  /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
  explicit Basis(const Vec3& n) : normal(n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z());
    const float b = n.x() * n.y() * a;
    tangent = Vec3(1.0f + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
    bitangent = Vec3(b, sign + n.y() * n.y() * a, -n.y());
  }

  Vec3 to_world(const Vec3& local) const {
    return local.x() * tangent + local.y() * bitangent + local.z() * normal;
  }
};

/// (cos, sin) of an angle in [-pi/4, pi/4] by Taylor polynomials. They are exact to the last bit or two,
/// several times faster than the general functions, and equal on every machine.
inline Vec2 cos_sin_octant(float angle) {
  const float x = angle * angle;
  const float s =
      angle * (1.0f + x * (-1.0f / 6.0f + x * (1.0f / 120.0f + x * (-1.0f / 5040.0f + x / 362880.0f))));
  const float c = 1.0f + x * (-0.5f + x * (1.0f / 24.0f + x * (-1.0f / 720.0f + x / 40320.0f)));
  return {c, s};
}

/// (cos, sin) of 2 pi u for u in [0, 1].
inline Vec2 cos_sin_turn(float u) {
  const int octant = static_cast<int>(u * 4.0f + 0.5f);  // NOLINT(bugprone-incorrect-roundings): u >= 0
  Vec2 cs = cos_sin_octant((u - 0.25f * static_cast<float>(octant)) * kTwoPi);
  switch (octant & 3) {
    case 0:
      return cs;
    case 1:
      return {-cs.y(), cs.x()};
    case 2:
      return -cs;
    default:
      return {cs.y(), -cs.x()};
  }
}

/// Uniform on the unit disk: Shirley and Chiu's concentric map.
inline Vec2 sample_concentric_disk(const Vec2& u) {
  const Vec2 a(2.0f * u.x() - 1.0f, 2.0f * u.y() - 1.0f);
  if (std::abs(a.x()) > std::abs(a.y())) {
    return a.x() * cos_sin_octant(0.25f * kPi * (a.y() / a.x()));
  }
  if (a.y() == 0.0f) return Vec2::Zero();
  const Vec2 cs = cos_sin_octant(0.25f * kPi * (a.x() / a.y()));
  return {a.y() * cs.y(), a.y() * cs.x()};
}

/// The pdf is cos / pi. The cosine of a sample may be 0, and then its pdf is 0.
inline Vec3 sample_cosine_hemisphere(const Vec2& u) {
  const Vec2 d = sample_concentric_disk(u);
  return {d.x(), d.y(), std::sqrt(std::max(0.0f, 1.0f - d.squaredNorm()))};
}
inline float pdf_cosine_hemisphere(float cos_theta) {
  return std::max(0.0f, cos_theta) * kInvPi;
}

inline Vec3 sample_uniform_sphere(const Vec2& u) {
  const float z = 1.0f - 2.0f * u.x();
  const float r = 2.0f * std::sqrt(std::max(0.0f, u.x() * (1.0f - u.x())));
  const Vec2 cs = cos_sin_turn(u.y());
  return {r * cs.x(), r * cs.y(), z};
}
inline float pdf_uniform_sphere() {
  return kInvFourPi;
}

inline Vec3 sample_uniform_hemisphere(const Vec2& u) {
  const float r = std::sqrt(std::max(0.0f, 1.0f - u.x() * u.x()));
  const Vec2 cs = cos_sin_turn(u.y());
  return {r * cs.x(), r * cs.y(), u.x()};
}
inline float pdf_uniform_hemisphere() {
  return kInvTwoPi;
}

/// Barycentric weights of the first and second corner, uniform by area; the pdf is 1 / area. Heitz 2019, "A
/// Low-Distortion Map Between Triangle and Square".
inline Vec2 sample_uniform_triangle(const Vec2& u) {
  if (u.y() > u.x()) {
    const float b0 = 0.5f * u.x();
    return {b0, u.y() - b0};
  }
  const float b1 = 0.5f * u.y();
  return {u.x() - b1, b1};
}

}  // namespace gatelight::renderer
