#pragma once
// The isotropic GGX distribution with height-correlated Smith shadowing, without Fresnel. Cosines are
// relative to the shading normal and positive on the side of wo.

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "renderer/bsdf/bsdf_constants.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {

/// sqrt(alpha^2 + (1 - alpha^2) cos^2): Smith's Lambda is (this / cos - 1) / 2.
inline float smith_root(float alpha2, float cosine) {
  return std::sqrt(alpha2 + (1.0f - alpha2) * cosine * cosine);
}

/// G2 / G1(wo), the weight of a sampled visible normal: (1 + L_o) / (1 + L_o + L_i), from the cosines and
/// their roots.
inline float smith_ratio(float cos_o, float root_o, float cos_i, float root_i) {
  return cos_i * (cos_o + root_o) / (cos_i * root_o + cos_o * root_i);
}
inline float smith_ratio(float alpha2, float cos_o, float cos_i) {
  return smith_ratio(cos_o, smith_root(alpha2, cos_o), cos_i, smith_root(alpha2, cos_i));
}

/// A microfacet normal h seen from wo, with the pdf G1(wo) max(0, wo.h) D(h) / wo.z, for an alpha along x and
/// one along y. Both vectors are in the frame of the shading normal, with wo.z > 0. Dupuy and Benyoub 2023,
/// "Sampling visible GGX normals with spherical caps".
inline Vec3 sample_visible_normal(float alpha_x, float alpha_y, const Vec3& wo, const Vec2& u) {
  const Vec3 stretched = Vec3(alpha_x * wo.x(), alpha_y * wo.y(), wo.z()).normalized();
  const Vec2 phi = cos_sin_turn(u.x());
  const float z = (1.0f - u.y()) * (1.0f + stretched.z()) - stretched.z();
  const float sine = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const Vec3 half(sine * phi.x() + stretched.x(), sine * phi.y() + stretched.y(), z + stretched.z());
  // Without the limit, rounding at the horizon can make z negative or the vector zero.
  return Vec3(alpha_x * half.x(), alpha_y * half.y(), std::max(half.z(), 1e-7f)).normalized();
}
inline Vec3 sample_visible_normal(float alpha, const Vec3& wo, const Vec2& u) {
  return sample_visible_normal(alpha, alpha, wo, u);
}

/// Directions distributed like the light that a rough lobe loses: proportional to cos / (cos^2 + a^2). This
/// is close to a cosine for large alpha and close to the horizon for small alpha.
struct LossLobe {
  float a2 = 1.0f;
  float log_norm = 1.0f;

  LossLobe() = default;
  explicit LossLobe(float alpha) : a2(2.0f * alpha * alpha), log_norm(std::log1p(1.0f / a2)) {}
  float pdf(float cosine) const { return cosine * kInvPi / ((cosine * cosine + a2) * log_norm); }
  Vec3 sample(const Vec2& u) const {
    const float cos2 = std::min(a2 * std::expm1(u.x() * log_norm), 1.0f);
    const Vec2 phi = cos_sin_turn(u.y());
    const float sine = std::sqrt(1.0f - cos2);
    return {sine * phi.x(), sine * phi.y(), std::sqrt(cos2)};
  }
};

/// A GGX distribution for one wo.
struct GgxLobe {
  float alpha2 = 1.0f;
  float cos_o = 1.0f;
  float root_o = 1.0f;     ///< smith_root(cos_o)
  float pdf_scale = 0.0f;  ///< G1(wo) / (4 cos_o)
  bool delta = false;

  GgxLobe() = default;
  GgxLobe(float alpha, float cosine) : alpha2(alpha * alpha), cos_o(cosine), delta(alpha < kDeltaAlpha) {
    root_o = smith_root(alpha2, cos_o);
    pdf_scale = 0.5f / (cos_o + root_o);
  }

  /// D of a half vector, and the visibility G2 / (4 cos_o cos_i). The half vector h need not be normalised;
  /// h2 > 0 is its squared length.
  struct Terms {
    float d;
    float visibility;
  };
  Terms terms(const Vec3& n, const Vec3& h, float h2, float cos_i) const {
    // The sine comes from a cross product, because 1 - cos^2 loses all digits for a narrow lobe.
    const float nh = n.dot(h);
    const float sin2 = n.cross(h).squaredNorm();
    const float root = alpha2 * nh * nh + sin2;
    const float d_below = kPi * root * root;
    const float v_below = cos_i * root_o + cos_o * smith_root(alpha2, cos_i);
    const float inverse = 1.0f / (d_below * v_below);
    return {alpha2 * h2 * h2 * v_below * inverse, 0.5f * d_below * inverse};
  }
};

}  // namespace gatelight::renderer
