#include "renderer/bsdf/sheen.h"

namespace gatelight::renderer {
namespace {

/// The integral of f(sin2_h, cos_i) cos_i over the hemisphere, for wo = (sin, 0, cosine).
template <class F>
float integrate(float cosine, F&& f) {
  constexpr int kSteps = 32;
  const Vec3 wo(std::sqrt(1.0f - cosine * cosine), 0.0f, cosine);
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    // The cosine is the square of the variable, so steps get finer towards the horizon.
    const float v = (static_cast<float>(i) + 0.5f) / kSteps;
    const float cos_i = v * v;
    const float sin_i = std::sqrt(1.0f - cos_i * cos_i);
    for (int j = 0; j < kSteps; ++j) {
      const float phi = kPi * (static_cast<float>(j) + 0.5f) / kSteps;
      const Vec3 h = (wo + Vec3(sin_i * std::cos(phi), sin_i * std::sin(phi), cos_i)).normalized();
      sum += static_cast<double>(f(1.0f - std::min(1.0f, h.z() * h.z()), cos_i) * cos_i * 2.0f * v);
    }
  }
  return static_cast<float>(sum) * 2.0f * kPi / (kSteps * kSteps);
}

float cosine_of_node(int i) {
  const float root = static_cast<float>(i) / (SheenTables::kCosine - 1);
  return std::max(root * root, 1e-4f);
}

}  // namespace

SheenTables::Row SheenTables::row(float roughness) const {
  const float x = (roughness - kMinSheenRoughness) * ((kRoughness - 1) / (1.0f - kMinSheenRoughness));
  const int i = std::clamp(static_cast<int>(x), 0, kRoughness - 2);
  Row row;
  row.low = values_[i].data();
  row.high = values_[i + 1].data();
  row.mix = x - static_cast<float>(i);
  return row;
}

SheenTables::SheenTables() {
  for (int k = 0; k < kRoughness; ++k) {
    const float roughness =
        kMinSheenRoughness + (1.0f - kMinSheenRoughness) * static_cast<float>(k) / (kRoughness - 1);
    Row own;
    own.low = own.high = values_[k].data();
    const SheenLobe lobe(roughness, own);
    for (int i = 0; i < kCosine; ++i) {
      const float cosine = cosine_of_node(i);
      values_[k][i][0] =
          integrate(cosine, [&](float sin2_h, float cos_i) { return lobe.undivided(sin2_h, cosine, cos_i); });
    }
    for (int i = 0; i < kCosine; ++i) {
      const float cosine = cosine_of_node(i);
      values_[k][i][1] =
          integrate(cosine, [&](float sin2_h, float cos_i) { return lobe.value(sin2_h, cosine, cos_i); });
    }
  }
}

const SheenTables& SheenTables::get() {
  static const SheenTables tables;
  return tables;
}

}  // namespace gatelight::renderer
