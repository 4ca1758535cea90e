#pragma once
// Directional albedos of a rough refracting interface with the exact Fresnel reflectance and single
// scattering.

#include <algorithm>
#include <array>

#include "base/math.h"

namespace gatelight::renderer {

/// Albedos for a microfacet reflectance of k F, which is 1 at total internal reflection. The table stores the
/// difference between the reflected power and that of a smooth interface, scaled to the power that is not
/// lost. A table could not represent the edge of the smooth interface at the critical angle.
struct GlassAlbedo {
  float lost = 0.0f;       ///< lost power for k = 1
  float change = 0.0f;     ///< with k: the lost power is lost + (1 - k) change
  float reflected = 0.0f;  ///< by F below the critical angle, minus F of the smooth interface
  float total = 0.0f;      ///< by total internal reflection, minus that of the smooth interface

  float loss(float k) const { return std::max(0.0f, lost + (1.0f - k) * change); }
};

/// A table over roughness, cosine (with the coordinate of GgxTables) and the signed root of the normal
/// reflectance, (eta - 1) / (eta + 1), for eta in [1/3, 3]. It has 80 KiB and is built at the first hit on a
/// rough refracting surface.
class GlassTables {
 public:
  static constexpr int kEta = 17;  // odd: the middle node is eta = 1
  static constexpr int kRoughness = 10;
  static constexpr int kCosine = 28;

  static constexpr int kMeans = 32;

  /// The interpolated table for one roughness and one eta.
  class Rows {
   public:
    GlassAlbedo at(float cosine) const;
    float loss_at(float cosine, float k) const { return at(cosine).loss(k); }
    /// The cosine-weighted mean of the loss over the hemisphere.
    float mean_loss(float k) const { return loss_ + (1.0f - k) * loss_change_; }
    /// The mean reflectance of the smooth interface.
    float mean_fresnel(float k) const { return k * fresnel_ + total_; }

   private:
    friend class GlassTables;
    const GlassTables* tables_ = nullptr;
    int eta_ = 0;
    int roughness_ = 0;
    float eta_mix_ = 0.0f;
    float roughness_mix_ = 0.0f;
    float alpha_ = 0.0f;
    float loss_ = 0.0f;
    float loss_change_ = 0.0f;
    float fresnel_ = 0.0f;
    float total_ = 0.0f;
  };

  static const GlassTables& get();
  /// `eta` is the index behind the interface divided by the index on the side of wo.
  Rows rows(float roughness, float eta) const;

 private:
  GlassTables();
  struct Mean {
    float loss, loss_change;  // divided by alpha^2, which makes them smooth in the roughness
  };
  struct Smooth {
    float fresnel, total;
  };
  std::array<std::array<std::array<GlassAlbedo, kCosine>, kRoughness>, kEta> values_;
  std::array<std::array<Mean, kMeans>, kEta> means_;
  std::array<Smooth, kEta> smooth_;
};

}  // namespace gatelight::renderer
