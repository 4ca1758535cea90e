#pragma once
// Directional albedos of the GGX reflection lobe for Schlick's Fresnel: what single scattering loses between
// the microfacets, and how much the grazing reflectance weighs.

#include <algorithm>
#include <array>

#include "renderer/bsdf_fresnel.h"

namespace gatelight::renderer {

/// The albedo of a lobe with reflectances f0 and f90 is f0 * a + f90 * b; loss is 1 - a - b.
struct GgxAlbedo {
  float loss = 0.0f;
  float b = 0.0f;
  float a() const { return 1.0f - loss - b; }
  float reflect(float f0, float f90) const { return f0 * a() + f90 * b; }
};

/// A table over roughness and cosine. Near the horizon the loss is a function of cosine / alpha alone, so the
/// cosine's coordinate is u = cosine (1 + alpha) / (cosine + alpha): the same few nodes resolve a dip that is
/// alpha wide. 8 KiB.
class GgxTables {
 public:
  static constexpr int kRoughness = 32;
  static constexpr int kCosine = 32;
  static constexpr int kMeans = 64;

  /// The interpolated rows for one roughness. A delta lobe loses nothing.
  class Row {
   public:
    Row() = default;
    GgxAlbedo at(float cosine) const {
      const float schlick = schlick_weight(cosine);
      if (low_ == nullptr) return {0.0f, schlick};
      const float x = cosine * scale_ / (cosine + alpha_);
      const int i = std::min(static_cast<int>(x), kCosine - 2);
      const float s = x - static_cast<float>(i);
      const float* l = low_ + 2 * i;
      const float* h = high_ + 2 * i;
      const float l0 = l[0] + s * (l[2] - l[0]);
      const float l1 = l[1] + s * (l[3] - l[1]);
      const float h0 = h[0] + s * (h[2] - h[0]);
      const float h1 = h[1] + s * (h[3] - h[1]);
      const float loss = l0 + mix_ * (h0 - l0);
      return {loss, l1 + mix_ * (h1 - l1) + (1.0f - loss) * schlick};
    }
    /// Cosine-weighted mean over the hemisphere.
    const GgxAlbedo& mean() const { return mean_; }

   private:
    friend class GgxTables;
    const float* low_ = nullptr;
    const float* high_ = nullptr;
    float mix_ = 0.0f;
    float alpha_ = 0.0f;
    float scale_ = 0.0f;
    GgxAlbedo mean_{0.0f, kSchlickMean};
  };

  /// Built at first use (some milliseconds), the same on every machine; safe from any thread.
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
    row.scale_ = (1.0f + alpha) * (kCosine - 1);
    const float y = roughness * (kMeans - 1);
    const int j = std::min(static_cast<int>(y), kMeans - 2);
    const float s = y - static_cast<float>(j);
    const auto& l = means_[j];
    const auto& h = means_[j + 1];
    row.mean_.loss = (l[0] + s * (h[0] - l[0])) * alpha * alpha;
    row.mean_.b = l[1] + s * (h[1] - l[1]);
    return row;
  }

 private:
  GgxTables();
  // Pairs: loss, and b less the Schlick weight of the cosine times 1 - loss.
  std::array<std::array<float, 2 * kCosine>, kRoughness> values_;
  // Pairs: mean loss over alpha^2, mean b.
  std::array<std::array<float, 2>, kMeans> means_;
};

}  // namespace gatelight::renderer
