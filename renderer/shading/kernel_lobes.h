#pragma once
// The lobes of the BSDF for all lanes: microfacets and sheen with their tables. Part of kernel_table.cpp.

#include "base/simd/groups.h"
#include "renderer/bsdf/bsdf_constants.h"
#include "renderer/shading/kernel_math.h"
#include "renderer/shading/kernels.h"

namespace {

using gatelight::renderer::BsdfTables;
using gatelight::renderer::kCoatF0;
using gatelight::renderer::kDeltaAlpha;
using gatelight::renderer::kGgxCosine;
using gatelight::renderer::kGgxParts;
using gatelight::renderer::kGgxRoughness;
using gatelight::renderer::kMinCosine;
using gatelight::renderer::kMinHalf2;
using gatelight::renderer::kMinSheenRoughness;
using gatelight::renderer::kSchlickMean;
using gatelight::renderer::kSheenCosine;
using gatelight::renderer::kSheenParts;
using gatelight::renderer::kSheenRoughness;

/// Words of a row of the tables, for one roughness, and of a pair of neighbours.
constexpr uint32_t kGgxRow = kGgxCosine * kGgxParts, kSheenRow = kSheenCosine * kSheenParts;

GATELIGHT_INLINE Float schlick_weight(Float cosine) {
  const Float x = clamp(1.0f - cosine, 0.0f, 1.0f), x2 = x * x;
  return x2 * x2 * x;
}
GATELIGHT_INLINE Float coat_fresnel(Float cosine) {
  return kCoatF0 + (1.0f - kCoatF0) * schlick_weight(cosine);
}
GATELIGHT_INLINE Float multiple_part(Float mean_fresnel, Float mean_loss) {
  return mean_fresnel * (1.0f - mean_loss) / (1.0f - mean_fresnel * mean_loss);
}
/// The first of two neighbours in a table of `count` entries, and the share of the second. NaN gives 0.
struct Place {
  Int index;
  Float share;
  GATELIGHT_INLINE Place(Float x, int count) {
    index = to_int(clamp(x, 0.0f, static_cast<float>(count - 2)));
    share = x - to_float(index);
  }
};
GATELIGHT_INLINE Float lerp(Float a, Float b, Float share) {
  return a + share * (b - a);
}

struct Albedo {
  Float loss, b, b_scaled, scale;
};
/// GgxTables::Row. A delta lobe has no energy loss.
struct GgxRow {
  const float* values;
  Int row;
  Float mix, alpha, u_scale;
  Mask smooth;

  GATELIGHT_INLINE GgxRow() = default;
  GATELIGHT_INLINE GgxRow(const BsdfTables& tables, Float roughness, Float roughness_alpha, Mask delta)
      : values(tables.ggx),
        alpha(roughness_alpha),
        u_scale((1.0f + roughness_alpha) * static_cast<float>(kGgxCosine - 1)),
        smooth(delta) {
    const Place place(roughness * static_cast<float>(kGgxRoughness - 1), kGgxRoughness);
    row = place.index;
    mix = place.share;
  }
  GATELIGHT_INLINE Albedo at(Float cosine) const {
    const Place place(cosine * u_scale / (cosine + alpha), kGgxCosine);
    const Records rows(row * kGgxRow + place.index * static_cast<uint32_t>(kGgxParts));
    const Float4 low0 = rows.four(values, 0), low1 = rows.four(values, kGgxParts);
    const Float4 high0 = rows.four(values, kGgxRow), high1 = rows.four(values, kGgxRow + kGgxParts);
    const auto part = [&](int k) __attribute__((always_inline)) {
      return lerp(lerp(low0.c[k], low1.c[k], place.share), lerp(high0.c[k], high1.c[k], place.share), mix);
    };
    const Float schlick = schlick_weight(cosine);
    const Float loss = part(0);
    Albedo a{loss, part(1) + (1.0f - loss) * schlick, part(2) + schlick, part(3)};
    if (any(smooth))
      a = {select(smooth, 0.0f, a.loss), select(smooth, schlick, a.b), select(smooth, schlick, a.b_scaled),
           select(smooth, 1.0f, a.scale)};
    return a;
  }
  /// The cosine-weighted mean; its scale has no meaning.
  GATELIGHT_INLINE Albedo mean(const BsdfTables& tables) const {
    const Records rows(row * static_cast<uint32_t>(kGgxParts));
    const Float4 low = rows.four(tables.ggx_means, 0), high = rows.four(tables.ggx_means, kGgxParts);
    const auto part = [&](int k, float of_delta) __attribute__((always_inline)) {
      return select(smooth, of_delta, lerp(low.c[k], high.c[k], mix));
    };
    return {part(0, 0.0f), part(1, kSchlickMean), part(2, kSchlickMean), 1.0f};
  }
};

/// GgxLobe, with the perceptual roughness clamped to [0, 1].
struct GgxLobe {
  Float alpha, alpha2, cos_o, root_o, pdf_scale;
  Mask delta;

  GgxLobe() = default;
  GATELIGHT_INLINE GgxLobe(Float roughness, Float cosine)
      : alpha(roughness * roughness), alpha2(alpha * alpha), cos_o(cosine), delta(alpha < kDeltaAlpha) {
    root_o = root(cos_o);
    pdf_scale = 0.5f / (cos_o + root_o);
  }
  GATELIGHT_INLINE Float root(Float cosine) const { return sqrt(alpha2 + (1.0f - alpha2) * cosine * cosine); }
  struct Terms {
    Float d, visibility;
  };
  GATELIGHT_INLINE Terms terms(Float3 n, Float3 h, Float h2, Float cos_i) const {
    const Float nh = dot(n, h);
    const Float3 c = cross(n, h);
    const Float r = alpha2 * nh * nh + dot(c, c);
    const Float d_below = kPi * r * r;
    const Float v_below = cos_i * root_o + cos_o * root(cos_i);
    const Float inverse = 1.0f / (d_below * v_below);
    return {alpha2 * h2 * h2 * v_below * inverse, 0.5f * d_below * inverse};
  }
};

/// SheenLobe and its row of SheenTables.
struct SheenLobe {
  const float* values;
  Int first;
  Float mix, exponent, scale;

  SheenLobe() = default;
  GATELIGHT_INLINE SheenLobe(const BsdfTables& tables, Float roughness) : values(tables.sheen) {
    constexpr float kScale = (kSheenRoughness - 1) / (1.0f - kMinSheenRoughness);
    const Place place((roughness - kMinSheenRoughness) * kScale, kSheenRoughness);
    first = place.index * kSheenRow;
    mix = place.share;
    exponent = 1.0f / (roughness * roughness);
    scale = (2.0f + exponent) * (0.125f * kInvPi);
  }
  /// part 0: the divisor before the limit of one; part 1: the albedo.
  GATELIGHT_INLINE Float lookup(uint32_t part, Float cosine) const {
    const Place place(sqrt(cosine) * static_cast<float>(kSheenCosine - 1), kSheenCosine);
    const Int at = first + place.index * static_cast<uint32_t>(kSheenParts);
    const auto pair = [&](const float* row) __attribute__((always_inline)) {
      return lerp(gather(row + part, at), gather(row + part + kSheenParts, at), place.share);
    };
    const Float low = pair(values), high = pair(values + kSheenRow);
    return lerp(low, high, mix);
  }
  GATELIGHT_INLINE Float value(Float sin2_h, Float cos_o, Float cos_i) const {
    const Float distribution = exp2(0.5f * exponent * log2(clamp(sin2_h, 1e-30f, 1.0f)));
    return scale * distribution / (cos_o + cos_i - cos_o * cos_i) /
           max(max(1.0f, lookup(0, cos_o)), max(1.0f, lookup(0, cos_i)));
  }
};

/// bend_normal() of bsdf.cpp.
GATELIGHT_INLINE Float3 bend_normal(Float3 n, Float3 ng, Float3 wo) {
  const Float on = dot(wo, n), og = max(dot(wo, ng), 0.0f);
  const Float mirrored = 2.0f * on * dot(n, ng) - og;
  const Float lifted = min(0.9f * og, 0.01f);
  const Mask stays = (mirrored >= lifted) & (on > 0.0f);
  if (!any(~stays)) return n;
  const Float tangent2 = 1.0f - mirrored * mirrored;
  const Float stretch = sqrt((1.0f - lifted * lifted) / tangent2);
  const Float3 tangent = n * (2.0f * on) - wo - ng * mirrored;
  const Float3 half = wo + tangent * stretch + ng * lifted;
  const Float length2 = dot(half, half);
  const Float3 bent = select((tangent2 > 1e-6f) & (length2 > 1e-8f), half * (1.0f / sqrt(length2)), ng);
  return select(stays, n, bent);
}

GATELIGHT_INLINE Float3 mirror(Float3 wo, Float3 n) {
  return n * (2.0f * dot(wo, n)) - wo;
}

}  // namespace
