#include "renderer/bsdf/glass_tables.h"

#include "renderer/bsdf/fresnel.h"
#include "renderer/bsdf/quadrature.h"

namespace gatelight::renderer {
namespace {

constexpr float kMaxRoot = 0.5f;

/// The root of the normal reflectance is the signed square of the coordinate in [-1, 1], because interfaces
/// change fast where the indices are almost equal.
float eta_of_node(int node) {
  const float x = 2.0f * static_cast<float>(node) / (GlassTables::kEta - 1) - 1.0f;
  float root = kMaxRoot * x * std::abs(x);
  // An interface between equal media does not scatter, but its limit does.
  if (root == 0.0f) root = 5e-4f;
  return (1.0f + root) / (1.0f - root);
}

GlassAlbedo integrate(float alpha, float cosine, float eta) {
  const float alpha2 = alpha * alpha;
  const Vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
  float reflected = 0.0f;
  float total = 0.0f;
  float transmitted = 0.0f;
  float unreflected = 0.0f;  // additional transmitted power if F were 0
  for_visible_normals<377, 233>(alpha, wo, [&](const Vec3& h, float weight) {
    const float oh = std::max(wo.dot(h), 0.0f);
    float cos_t;
    const float fresnel = fresnel_dielectric(oh, eta, cos_t);
    const float cos_r = 2.0f * oh * h.z() - cosine;
    const float kept = weight * (cos_r > 0.0f ? smith_ratio(alpha2, cosine, cos_r) : 0.0f);
    if (cos_t > 0.0f) {
      const float cos_i = (cosine - oh * h.z()) / eta + cos_t * h.z();
      const float passed = weight * (cos_i > 0.0f ? smith_ratio(alpha2, cosine, cos_i) : 0.0f);
      reflected += fresnel * kept;
      transmitted += (1.0f - fresnel) * passed;
      unreflected += fresnel * passed;
    } else {
      total += kept;
    }
  });
  float cos_t;
  const float smooth = fresnel_dielectric(cosine, eta, cos_t) * (reflected + total + transmitted);
  return {1.0f - reflected - total - transmitted, reflected - unreflected,
          cos_t > 0.0f ? reflected - smooth : reflected, cos_t > 0.0f ? total : total - smooth};
}

GlassAlbedo mix(const GlassAlbedo& a, const GlassAlbedo& b, float t) {
  return {a.lost + t * (b.lost - a.lost), a.change + t * (b.change - a.change),
          a.reflected + t * (b.reflected - a.reflected), a.total + t * (b.total - a.total)};
}

}  // namespace

GlassAlbedo GlassTables::Rows::at(float cosine) const {
  const float x = std::max(0.0f, cosine * (1.0f + alpha_) / (cosine + alpha_)) * (kCosine - 1);
  const int i = std::min(static_cast<int>(x), kCosine - 2);
  const float s = x - static_cast<float>(i);
  const auto along = [&](int eta, int roughness) {
    const auto& row = tables_->values_[eta][roughness];
    return mix(row[i], row[i + 1], s);
  };
  const auto& rows = roughness_;
  return mix(mix(along(eta_, rows), along(eta_, rows + 1), roughness_mix_),
             mix(along(eta_ + 1, rows), along(eta_ + 1, rows + 1), roughness_mix_), eta_mix_);
}

GlassTables::Rows GlassTables::rows(float roughness, float eta) const {
  Rows rows;
  rows.tables_ = this;
  rows.alpha_ = roughness * roughness;
  const float root = std::clamp((eta - 1.0f) / (eta + 1.0f), -kMaxRoot, kMaxRoot);
  const float coordinate = std::copysign(std::sqrt(std::abs(root) / kMaxRoot), root);
  const float x = (coordinate + 1.0f) * (0.5f * (kEta - 1));
  rows.eta_ = std::min(static_cast<int>(x), kEta - 2);
  rows.eta_mix_ = x - static_cast<float>(rows.eta_);
  const float y = roughness * (kRoughness - 1);
  rows.roughness_ = std::min(static_cast<int>(y), kRoughness - 2);
  rows.roughness_mix_ = y - static_cast<float>(rows.roughness_);

  const float z = roughness * (kMeans - 1);
  const int j = std::min(static_cast<int>(z), kMeans - 2);
  const float s = z - static_cast<float>(j);
  const auto lerp = [](float a, float b, float t) { return a + t * (b - a); };
  const auto mean = [&](float Mean::*part) {
    const auto& low = means_[rows.eta_];
    const auto& high = means_[rows.eta_ + 1];
    return lerp(lerp(low[j].*part, low[j + 1].*part, s), lerp(high[j].*part, high[j + 1].*part, s),
                rows.eta_mix_);
  };
  const float alpha2 = rows.alpha_ * rows.alpha_;
  rows.loss_ = mean(&Mean::loss) * alpha2;
  rows.loss_change_ = mean(&Mean::loss_change) * alpha2;
  rows.fresnel_ = lerp(smooth_[rows.eta_].fresnel, smooth_[rows.eta_ + 1].fresnel, rows.eta_mix_);
  rows.total_ = lerp(smooth_[rows.eta_].total, smooth_[rows.eta_ + 1].total, rows.eta_mix_);
  return rows;
}

GlassTables::GlassTables() {
  means_ = {};
  smooth_ = {};
  for (int e = 0; e < kEta; ++e) {
    const float eta = eta_of_node(e);
    for (int k = 0; k < kRoughness; ++k) {
      const float roughness = static_cast<float>(k) / (kRoughness - 1);
      const float alpha = std::max(roughness * roughness, kDeltaAlpha);
      for (int i = 0; i < kCosine; ++i) {
        values_[e][k][i] = integrate(alpha, table_cosine(static_cast<float>(i) / (kCosine - 1), alpha), eta);
      }
    }
  }
  for (int e = 0; e < kEta; ++e) {
    const float eta = eta_of_node(e);
    for_mean_cosines([&](float cosine, float weight) {
      float cos_t;
      const float fresnel = weight * fresnel_dielectric(cosine, eta, cos_t);
      (cos_t > 0.0f ? smooth_[e].fresnel : smooth_[e].total) += fresnel;
    });
    for (int k = 0; k < kMeans; ++k) {
      const float roughness = std::max(static_cast<float>(k) / (kMeans - 1), kDeltaRoughness);
      Rows interpolated = rows(roughness, 1.0f);
      interpolated.eta_ = std::min(e, kEta - 2);
      interpolated.eta_mix_ = static_cast<float>(e - interpolated.eta_);
      Mean mean{0.0f, 0.0f};
      for_mean_cosines([&](float cosine, float weight) {
        const GlassAlbedo albedo = interpolated.at(cosine);
        mean.loss += weight * albedo.lost;
        mean.loss_change += weight * albedo.change;
      });
      const float alpha2 = roughness * roughness * roughness * roughness;
      means_[e][k] = {mean.loss / alpha2, mean.loss_change / alpha2};
    }
  }
}

const GlassTables& GlassTables::get() {
  static const GlassTables tables;
  return tables;
}

}  // namespace gatelight::renderer
