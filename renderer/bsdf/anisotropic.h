#pragma once
// The anisotropic GGX distribution (KHR_materials_anisotropy): alpha differs along two axes of the surface.
// Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", section 5.3.

#include <array>
#include <cmath>
#include <vector>

#include "renderer/bsdf/ggx.h"
#include "renderer/bsdf/tables.h"

namespace gatelight::renderer {

/// Albedos of anisotropic lobes, by roughness, strength, cosine and direction around the normal. Built at
/// first use, equal on every machine. Any thread may call it.
class AnisotropicTables {
 public:
  static constexpr int kRoughness = 16;
  static constexpr int kStrength = 11;
  static constexpr int kCosine = 20;
  static constexpr int kTurn = 6;

  using Entry = std::array<float, 4>;  ///< the four numbers of GgxTables
  using Slice = std::array<std::array<Entry, kTurn>, kCosine>;

  /// The albedos of one lobe.
  struct Row {
    float alpha_x = 1.0f;  ///< along the direction of greater roughness
    float alpha_y = 1.0f;
    const Slice* slice = nullptr;  ///< the slice of the lower nodes; those of the upper nodes follow
    float roughness_mix = 0.0f;
    float strength_mix = 0.0f;
    GgxAlbedo mean;  ///< over the hemisphere; its scale has no meaning

    /// The albedo for a direction of this cosine whose projection on the surface has the squared cosine
    /// `along2` with x.
    GgxAlbedo at(float cosine, float along2) const;
  };

  static const AnisotropicTables& get();
  /// The row for a roughness and a strength in [0, 1].
  Row row(float roughness, float strength) const;

 private:
  AnisotropicTables();
  void fill(Slice& slice, float alpha_x, float alpha_y) const;

  std::vector<Slice> slices_;  ///< [roughness][strength]
  std::vector<GgxAlbedo> means_;
};

/// An anisotropic distribution for one wo.
struct AnisotropicLobe {
  Vec3 x, y, n;  ///< world: the direction of greater roughness, the one across it, the normal
  float alpha_x = 1.0f, alpha_y = 1.0f;
  AnisotropicTables::Row row;

  AnisotropicLobe() = default;
  /// `direction` need not be perpendicular to `normal`, but must not be parallel to it.
  AnisotropicLobe(float roughness, float strength, const Vec3& direction, const Vec3& normal);

  Vec3 local(const Vec3& w) const { return {w.dot(x), w.dot(y), w.dot(n)}; }
  /// smith_root() of ggx.h: Smith's Lambda is (this / cos - 1) / 2.
  float root(const Vec3& w) const {
    const Vec3 l = local(w);
    return Vec3(alpha_x * l.x(), alpha_y * l.y(), l.z()).norm();
  }
  /// GgxLobe::terms(). wo and wi are on the side of n.
  GgxLobe::Terms terms(const Vec3& h, float h2, float cos_o, float root_o, const Vec3& wi,
                       float cos_i) const {
    const Vec3 l = local(h);
    const float xx = l.x() / alpha_x, yy = l.y() / alpha_y;
    const float sum = xx * xx + yy * yy + l.z() * l.z();
    return {h2 * h2 / (kPi * alpha_x * alpha_y * sum * sum), 0.5f / (cos_i * root_o + cos_o * root(wi))};
  }
  Vec3 sample_half(const Vec3& wo, float cos_o, const Vec2& u) const {
    const Vec3 h = sample_visible_normal(alpha_x, alpha_y, {wo.dot(x), wo.dot(y), cos_o}, u);
    return h.x() * x + h.y() * y + h.z() * n;
  }
  GgxAlbedo albedo(const Vec3& w, float cosine) const {
    const float a = w.dot(x), b = w.dot(y), square = a * a + b * b;
    return row.at(cosine, square > 0.0f ? a * a / square : 0.0f);
  }
};

}  // namespace gatelight::renderer
