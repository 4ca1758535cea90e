#pragma once
// Sheen of cloth at grazing angles: the distribution of Estevez and Kulla 2017, "Production Friendly
// Microfacet Sheen BRDF", with the visibility of Neubelt and Pettineo, as in KHR_materials_sheen.

#include <algorithm>
#include <array>
#include <cmath>

#include "base/math.h"
#include "renderer/bsdf/bsdf_constants.h"

namespace gatelight::renderer {

/// A table over roughness and the root of the cosine, built at the first hit on a surface with sheen. The
/// model reflects up to twice the incident light (small roughness, grazing angles). So it is divided by the
/// larger of its directional albedos for wo and wi where that exceeds one. The result is reciprocal and never
/// gains energy.
class SheenTables {
 public:
  static constexpr int kRoughness = kSheenRoughness;
  static constexpr int kCosine = kSheenCosine;

  struct Row {
    /// The divisor for one of the two directions. The larger divisor applies.
    float divisor(float cosine) const { return std::max(1.0f, lookup(0, cosine)); }
    /// The directional albedo of white sheen after the division.
    float albedo(float cosine) const { return lookup(1, cosine); }

   private:
    friend class SheenTables;
    float lookup(int part, float cosine) const {
      const float x = std::sqrt(cosine) * (kCosine - 1);
      const int i = std::min(static_cast<int>(x), kCosine - 2);
      const float s = x - static_cast<float>(i);
      const float a = low[i][part] + s * (low[i + 1][part] - low[i][part]);
      const float b = high[i][part] + s * (high[i + 1][part] - high[i][part]);
      return a + mix * (b - a);
    }
    const std::array<float, 2>* low = nullptr;
    const std::array<float, 2>* high = nullptr;
    float mix = 0.0f;
  };

  static const SheenTables& get();
  Row row(float roughness) const;
  /// For the kernels: [roughness][cosine][divisor, albedo].
  const float* values() const { return values_[0][0].data(); }

 private:
  SheenTables();
  std::array<std::array<std::array<float, kSheenParts>, kCosine>, kRoughness> values_;
};

/// A lobe of white sheen.
struct SheenLobe {
  float exponent = 1.0f;  ///< 1 / alpha
  float scale = 1.0f;  ///< (2 + exponent) / (8 pi): the norm of the distribution times 1/4 of the visibility
  SheenTables::Row row;

  SheenLobe() = default;
  /// The roughness is at least kMinSheenRoughness.
  SheenLobe(float roughness, const SheenTables::Row& table_row) : row(table_row) {
    exponent = 1.0f / (roughness * roughness);
    scale = (2.0f + exponent) * (0.125f * kInvPi);
  }
  /// The value before the division. sin2_h is the squared sine of the half vector.
  float undivided(float sin2_h, float cos_o, float cos_i) const {
    const float distribution = std::exp2(0.5f * exponent * std::log2(std::clamp(sin2_h, 1e-30f, 1.0f)));
    return scale * distribution / (cos_o + cos_i - cos_o * cos_i);
  }
  float value(float sin2_h, float cos_o, float cos_i) const {
    return undivided(sin2_h, cos_o, cos_i) / std::max(row.divisor(cos_o), row.divisor(cos_i));
  }
};

}  // namespace gatelight::renderer
