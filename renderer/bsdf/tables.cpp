#include "renderer/bsdf/tables.h"

#include <tbb/task_arena.h>

#include "base/parallel/loops.h"
#include "renderer/bsdf/quadrature.h"

namespace gatelight::renderer {

GgxTables::GgxTables() {
  const auto fill = [&](std::size_t number) {
    const int k = static_cast<int>(number);
    const float roughness = static_cast<float>(k) / (kRoughness - 1);
    const float alpha = std::max(roughness * roughness, kDeltaAlpha);
    const float alpha2 = alpha * alpha;

    // The light that goes from each cosine to each other one, for the reflectance 1 and for Schlick's weight.
    CosineMatrix<kCosine> all;
    CosineMatrix<kCosine> grazing;
    for (int i = 0; i < kCosine; ++i) {
      const float cosine = table_cosine(static_cast<float>(i) / (kCosine - 1), alpha);
      const Vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
      for_visible_normals<377, 233>(alpha, wo, [&](const Vec3& h, float weight) {
        const float oh = wo.dot(h);
        const float cos_i = 2.0f * oh * h.z() - cosine;
        if (!(cos_i > 0.0f)) return;
        const float kept = weight * smith_ratio(alpha2, cosine, cos_i);
        all.add(i, cos_i, alpha, kept);
        grazing.add(i, cos_i, alpha, kept * schlick_weight(oh));
      });
    }

    const std::array<float, kCosine> scale = balance<kCosine>(all);
    std::array<float, kCosine> ones;
    ones.fill(1.0f);
    for (int i = 0; i < kCosine; ++i) {
      const float schlick = schlick_weight(table_cosine(static_cast<float>(i) / (kCosine - 1), alpha));
      const float kept = all.row_sum(i, ones);
      values_[k][i] = {1.0f - kept, grazing.row_sum(i, ones) - kept * schlick,
                       scale[i] * grazing.row_sum(i, scale) - schlick, scale[i]};
    }
  };
  // Isolated: a thread that waits here must not begin a task that needs these tables.
  tbb::this_task_arena::isolate([&] { for_each(kRoughness, fill); });
  // The means are those of the interpolated table itself, so that the coupled diffuse lobe sums to the
  // transmitted light.
  means_ = {};
  for (int k = 0; k < kRoughness; ++k) {
    const Row own = row(std::max(static_cast<float>(k) / (kRoughness - 1), kDeltaRoughness));
    for_mean_cosines([&](float cosine, float weight) {
      const GgxAlbedo albedo = own.at(cosine);
      means_[k].loss += weight * albedo.loss;
      means_[k].b += weight * albedo.b;
      means_[k].b_scaled += weight * albedo.b_scaled;
    });
  }
}

const GgxTables& GgxTables::get() {
  static const GgxTables tables;
  return tables;
}

}  // namespace gatelight::renderer
