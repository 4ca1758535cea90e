#pragma once
// Directional albedos of the GGX reflection lobe with Schlick's Fresnel reflectance, and the scale that
// restores the energy that single scattering loses between the microfacets.

#include <algorithm>
#include <array>

#include "renderer/bsdf/bsdf_constants.h"
#include "renderer/bsdf/fresnel.h"

namespace gatelight::renderer {

/// Albedos for one cosine. The albedo of a lobe with reflectances f0 and f90 is f0 (1 - loss - b) + f90 b. A
/// lobe multiplied by scale(cos_o) scale(cos_i) loses nothing: its albedo is f0 (1 - b_scaled) + f90
/// b_scaled.
struct GgxAlbedo {
  float loss = 0.0f;
  float b = 0.0f;
  float b_scaled = 0.0f;
  float scale = 1.0f;
  float reflect(float f0, float f90) const { return f0 * (1.0f - loss - b) + f90 * b; }
};

/// A table over roughness and cosine, of 16 KiB. Near the horizon the loss depends only on cosine / alpha. So
/// the coordinate of the cosine is u = cosine (1 + alpha) / (cosine + alpha), and few nodes resolve a dip of
/// width alpha.
class GgxTables {
 public:
  static constexpr int kRoughness = kGgxRoughness;
  static constexpr int kCosine = kGgxCosine;

  /// The interpolated rows for one roughness. A delta lobe loses nothing.
  class Row {
   public:
    Row() = default;
    GgxAlbedo at(float cosine) const {
      const float schlick = schlick_weight(cosine);
      if (low_ == nullptr) return {0.0f, schlick, schlick, 1.0f};
      const float x = cosine * u_scale_ / (cosine + alpha_);
      const int i = std::min(static_cast<int>(x), kCosine - 2);
      const float s = x - static_cast<float>(i);
      const auto part = [&](int k) {
        const float l = low_[i][k] + s * (low_[i + 1][k] - low_[i][k]);
        const float h = high_[i][k] + s * (high_[i + 1][k] - high_[i][k]);
        return l + mix_ * (h - l);
      };
      const float loss = part(0);
      return {loss, part(1) + (1.0f - loss) * schlick, part(2) + schlick, part(3)};
    }
    /// The cosine-weighted mean over the hemisphere. Its `scale` has no meaning.
    const GgxAlbedo& mean() const { return mean_; }

   private:
    friend class GgxTables;
    const std::array<float, 4>* low_ = nullptr;
    const std::array<float, 4>* high_ = nullptr;
    float mix_ = 0.0f;
    float alpha_ = 0.0f;
    float u_scale_ = 0.0f;
    GgxAlbedo mean_{0.0f, kSchlickMean, kSchlickMean, 1.0f};
  };

  /// Built at first use in some milliseconds, equal on every machine. Any thread may call it.
  static const GgxTables& get();

  Row row(float roughness) const {
    Row row;
    const float alpha = roughness * roughness;
    const float x = roughness * (kRoughness - 1);
    const int i = std::min(static_cast<int>(x), kRoughness - 2);
    row.low_ = values_[i].data();
    row.high_ = values_[i + 1].data();
    row.mix_ = x - static_cast<float>(i);
    row.alpha_ = alpha;
    row.u_scale_ = (1.0f + alpha) * (kCosine - 1);
    const GgxAlbedo& l = means_[i];
    const GgxAlbedo& h = means_[i + 1];
    row.mean_.loss = l.loss + row.mix_ * (h.loss - l.loss);
    row.mean_.b = l.b + row.mix_ * (h.b - l.b);
    row.mean_.b_scaled = l.b_scaled + row.mix_ * (h.b_scaled - l.b_scaled);
    return row;
  }

  /// For the kernels: [roughness][cosine][4] and [roughness][4], with the parts of GgxAlbedo.
  const float* values() const { return values_[0][0].data(); }
  const float* means() const { return &means_[0].loss; }

 private:
  GgxTables();
  // With the Schlick weight w of the cosine itself: loss; b - w (1 - loss); b_scaled - w; scale.
  std::array<std::array<std::array<float, kGgxParts>, kCosine>, kRoughness> values_;
  std::array<GgxAlbedo, kRoughness> means_;
};

}  // namespace gatelight::renderer
