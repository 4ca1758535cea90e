#pragma once
// Directional albedos of a rough refracting interface with exact Fresnel, single scattering.

#include <algorithm>
#include <array>

#include "scene/math.h"

namespace gatelight::renderer {

/// Power that leaves the interface, as parts of what arrives. For the reflectance k F (and 1 at total
/// internal reflection) the interface reflects k reflected + total and transmits transmitted + (1 - k)
/// unreflected.
struct GlassAlbedo {
  float reflected = 0.0f;    ///< by F below the critical angle
  float total = 0.0f;        ///< by total internal reflection
  float transmitted = 0.0f;  ///< by 1 - F
  float unreflected = 0.0f;  ///< would be transmitted in addition if F were 0 below the critical angle

  float reflect(float k) const { return k * reflected + total; }
  float transmit(float k) const { return transmitted + (1.0f - k) * unreflected; }
  float loss(float k) const { return std::max(0.0f, 1.0f - reflect(k) - transmit(k)); }
};

/// Over roughness, cosine (with the coordinate of GgxTables) and the signed root of the normal reflectance,
/// (eta - 1) / (eta + 1), for eta in [1/3, 3]. 64 KiB, built when the first rough refracting surface is met.
class GlassTables {
 public:
  static constexpr int kEta = 17;  // odd: the middle one is eta = 1
  static constexpr int kRoughness = 10;
  static constexpr int kCosine = 28;

  static constexpr int kMeans = 32;

  /// The table for one roughness and eta.
  class Rows {
   public:
    GlassAlbedo at(float cosine) const;
    /// Cosine-weighted mean of the loss over the hemisphere.
    float mean_loss(float k) const { return loss_ + (1.0f - k) * loss_change_; }
    /// Mean reflectance of the smooth interface.
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
  /// eta: index behind the interface over the index on the side of wo.
  Rows rows(float roughness, float eta) const;

 private:
  GlassTables();
  struct Mean {
    float loss, loss_change;  // over alpha^2, which makes them smooth in the roughness
  };
  struct Smooth {
    float fresnel, total;
  };
  std::array<std::array<std::array<GlassAlbedo, kCosine>, kRoughness>, kEta> values_;
  std::array<std::array<Mean, kMeans>, kEta> means_;
  std::array<Smooth, kEta> smooth_;
};

}  // namespace gatelight::renderer
