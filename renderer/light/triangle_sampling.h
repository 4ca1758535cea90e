#pragma once
// Samples points on a triangle as seen from a point: uniform by solid angle where the triangle looks large,
// uniform by area where it looks so small that both agree. The decision depends only on the point and the
// triangle, so the pdf of a direction from another technique can be computed.

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {

/// A corner and the two edges from it. The cross product of the edges points to the front.
struct TriangleCorners {
  Vec3 corner;
  Vec3 edge1;
  Vec3 edge2;
};

struct TrianglePoint {
  Vec2 barycentrics = Vec2::Zero();  ///< weights of the ends of edge1 and edge2
  float pdf = 0.0f;                  ///< per area, or per solid angle
  bool per_solid_angle = false;
};

/// Bounds in steradians, from pbrt-v4. Below the minimum, area sampling adds almost no variance. Above the
/// maximum, nearly the whole hemisphere, the point lies in the plane of the triangle except for rounding.
inline constexpr float kMinSolidAngle = 3e-4f;
inline constexpr float kMaxSolidAngle = 6.22f;

/// The solid angle of a triangle seen from the origin, and the unit directions of its corners: Van Oosterom
/// and Strackee 1983. The triple product uses one corner and the edges, which is precise for small triangles.
struct SphericalTriangle {
  Vec3 a, b, c;      ///< unit
  float g0, g1, g2;  ///< terms of the half angle: tan(solid_angle / 2) = g0 / (g1 + g2)
  float solid_angle;

  /// Inlined by force: the result of a call goes through memory, which makes a sample an eighth more
  /// expensive.
  [[gnu::always_inline]] explicit SphericalTriangle(const TriangleCorners& t) {
    const Vec3 pb = t.corner + t.edge1;
    const Vec3 pc = t.corner + t.edge2;
    const float inv_a = 1.0f / t.corner.norm();
    const float inv_b = 1.0f / pb.norm();
    const float inv_c = 1.0f / pc.norm();
    a = t.corner * inv_a;
    b = pb * inv_b;
    c = pc * inv_c;
    g0 = std::abs(a.dot((t.edge1 * inv_b).cross(t.edge2 * inv_c)));
    g1 = a.dot(c) + b.dot(c);
    g2 = 1.0f + a.dot(b);
    solid_angle = 2.0f * std::atan2(g0, g1 + g2);
  }

  /// Uniform on the spherical triangle: an arc through b cuts off a part of the area, then a point is chosen
  /// on that arc (Arvo 1995). This form without inverse trigonometric functions is from Peters 2021, "BRDF
  /// Importance Sampling for Polygonal Lights".
  Vec3 sample(const Vec2& u) const {
    const float half = 0.5f * solid_angle * u.x();  // in [0, pi)
    const float cos_half = std::cos(half);
    const float sin_half = std::sin(half);
    const Vec3 r = (g0 * cos_half - g1 * sin_half) * a + (g2 * sin_half) * c;
    const float norm2 = r.squaredNorm();
    Vec3 end = c;
    if (norm2 > 0.0f) end = (2.0f * a.dot(r) / norm2) * r - a;
    // Uniform in the cosine along the arc from b to end. The chord gives a precise 1 - cos.
    const float whole = 0.5f * (end - b).squaredNorm();
    const float part = u.y() * whole;
    const float cos_end = 1.0f - whole;
    const float scale = std::sqrt(std::max(0.0f, u.y() * (2.0f - part) / std::max(2.0f - whole, 1e-12f)));
    return ((1.0f - part) - scale * cos_end) * b + scale * end;
  }
};

/// Whether area sampling is good enough, without computing the solid angle, which costs an arc tangent. The
/// area over the squared distance of the nearest corner bounds the solid angle, except for slivers that pass
/// close by.
inline bool looks_tiny(const TriangleCorners& t, float area) {
  const float nearest = std::min(
      {t.corner.squaredNorm(), (t.corner + t.edge1).squaredNorm(), (t.corner + t.edge2).squaredNorm()});
  return area < kMinSolidAngle * nearest;
}

inline bool samples_solid_angle(const SphericalTriangle& s) {
  return s.solid_angle >= kMinSolidAngle && s.solid_angle <= kMaxSolidAngle;
}

/// The pdf per solid angle with which sample_triangle_point() returns a direction that hits the triangle at
/// `distance`. `cos_light` is the absolute cosine there. The triangle is relative to the point.
inline float pdf_triangle_point(const TriangleCorners& t, float area, float cos_light, float distance) {
  if (!looks_tiny(t, area)) {
    const SphericalTriangle s(t);
    if (samples_solid_angle(s)) return 1.0f / s.solid_angle;
  }
  return distance * distance / (area * cos_light);
}

/// The triangle is relative to the point from which it is seen.
inline TrianglePoint sample_triangle_point(const TriangleCorners& t, float area, const Vec2& u) {
  TrianglePoint point;
  if (!looks_tiny(t, area)) {
    const SphericalTriangle s(t);
    if (samples_solid_angle(s)) {
      // Intersects the ray from the origin with the plane of the triangle: Moeller and Trumbore 1997.
      const Vec3 d = s.sample(u);
      const Vec3 p = d.cross(t.edge2);
      const float determinant = t.edge1.dot(p);
      if (determinant != 0.0f) {
        const Vec3 q = t.corner.cross(t.edge1);
        float b1 = std::clamp(-t.corner.dot(p) / determinant, 0.0f, 1.0f);
        float b2 = std::clamp(-d.dot(q) / determinant, 0.0f, 1.0f);
        if (b1 + b2 > 1.0f) {
          const float scale = 1.0f / (b1 + b2);
          b1 *= scale;
          b2 *= scale;
        }
        return {Vec2(b1, b2), 1.0f / s.solid_angle, true};
      }
      return point;
    }
  }
  const Vec2 weights = sample_uniform_triangle(u);
  point.barycentrics = {weights.y(), 1.0f - weights.x() - weights.y()};
  point.pdf = 1.0f / area;
  return point;
}

}  // namespace gatelight::renderer
