#include "renderer/bsdf_tables.h"

#include "renderer/bsdf_quadrature.h"

namespace gatelight::renderer {
namespace {

GgxAlbedo integrate(float alpha, float cosine) {
  const float alpha2 = alpha * alpha;
  const Vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
  double loss = 0.0;
  double b = 0.0;
  for_visible_normals<42>(alpha, wo, [&](const Vec3& h, float weight) {
    const float oh = wo.dot(h);
    const float cos_i = 2.0f * oh * h.z() - cosine;
    const float kept = cos_i > 0.0f ? smith_ratio(alpha2, cosine, cos_i) : 0.0f;
    loss += static_cast<double>(weight * (1.0f - kept));
    b += static_cast<double>(weight * kept * schlick_weight(oh));
  });
  return {static_cast<float>(loss), static_cast<float>(b)};
}

}  // namespace

GgxTables::GgxTables() {
  for (int k = 0; k < kRoughness; ++k) {
    const float roughness = static_cast<float>(k) / (kRoughness - 1);
    const float alpha = std::max(roughness * roughness, kDeltaAlpha);
    for (int i = 0; i < kCosine; ++i) {
      const float cosine = table_cosine(static_cast<float>(i) / (kCosine - 1), alpha);
      const GgxAlbedo albedo = integrate(alpha, cosine);
      values_[k][2 * i] = albedo.loss;
      values_[k][2 * i + 1] = albedo.b - (1.0f - albedo.loss) * schlick_weight(cosine);
    }
  }
  // The means of the interpolated table itself, so that what is given back adds up to what was lost.
  means_ = {};
  for (int k = 0; k < kMeans; ++k) {
    const float roughness = std::max(static_cast<float>(k) / (kMeans - 1), kDeltaRoughness);
    const float alpha = roughness * roughness;
    const Row interpolated = row(roughness);
    double loss = 0.0;
    double b = 0.0;
    for_mean_cosines([&](float cosine, float weight) {
      const GgxAlbedo albedo = interpolated.at(cosine);
      loss += static_cast<double>(weight * albedo.loss);
      b += static_cast<double>(weight * albedo.b);
    });
    means_[k] = {static_cast<float>(loss) / (alpha * alpha), static_cast<float>(b)};
  }
}

const GgxTables& GgxTables::get() {
  static const GgxTables tables;
  return tables;
}

}  // namespace gatelight::renderer
