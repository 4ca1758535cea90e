#pragma once
// The opaque and thin-walled BSDF for all lanes: the SIMD version of renderer/bsdf, lobe by lobe. Microfacets
// and clearcoat may be deltas. Part of kernel_table.cpp.

#include "renderer/shading/kernel_lobes.h"
#include "renderer/shading/kernel_sampler.h"
#include "renderer/shading/kernels.h"

namespace {

using gatelight::renderer::ShadingBlock;
using gatelight::renderer::ShadingContext;

struct LaneValue {
  Float3 value;
  Float pdf;
  Float3 wide;  ///< the value of the wide lobes, where LaneBsdf::separates_wide
};
struct LaneSample {
  Float3 wi, weight, wide_weight;
  Float pdf, spread;
  Mask delta, transmitted;
};

/// Bsdf, without refraction.
struct LaneBsdf {
  Float3 wo, ng, ns, nc;
  GgxLobe ggx, coat;
  GgxRow row;
  SheenLobe sheen;
  Float scale_o, f90, base_scale, coat_weight;
  Float3 f0, multiple_f0, multiple_f90, diffuse, diffuse_through, tint, glass_f0, sheen_color;
  Float glass_f90;
  Float coupling[4];
  Float3 albedo;
  Float p_microfacet, p_diffuse, p_through, p_coat, p_sheen;
  Mask thin, through, coated, has_sheen;  ///< through: a diffuse base on the other side
  bool any_thin, any_through, any_coat, any_sheen, separates_wide;
  Mask is_delta;
  Mask wide_facets, wide_coat;  ///< where separates_wide
  Float3 wide_albedo;

  GATELIGHT_INLINE LaneBsdf(const ShadingBlock& block, const ShadingContext& context, int at)
      : wo(load(block.wo, at)),
        ng(load(block.geometric_normal, at)),
        ns(bend_normal(load(block.shading_normal, at), ng, wo)) {
    const BsdfTables& tables = context.tables;
    separates_wide = context.separates_wide;
    set_up_base(block, tables, at);
    set_up_layers(block, tables, at);
    albedo = clamp(albedo, 0.0f, 1.0f);
    if (separates_wide) separate_wide(tables, context.min_roughness);
    p_microfacet = max(p_microfacet, 1e-3f * f90 * base_scale);
    if (context.narrow_only) keep_narrow();
    const Float total = p_microfacet + p_diffuse + p_through + p_coat + p_sheen;
    const Float scale = select(total > 0.0f, 1.0f / total, 0.0f);
    p_microfacet *= scale;
    p_diffuse *= scale;
    p_through *= scale;
    p_coat *= scale;
    p_sheen *= scale;
    is_delta = (p_diffuse == 0.0f) & (p_through == 0.0f) & (p_sheen == 0.0f) &
               (ggx.delta | (p_microfacet == 0.0f)) & ((p_coat == 0.0f) | coat.delta);
  }

  GATELIGHT_INLINE void set_up_base(const ShadingBlock& block, const BsdfTables& tables, int at) {
    const Float3 base = clamp(load(block.base_color, at), 0.0f, 1.0f);
    const Float metallic = clamp(load(block.metallic + at), 0.0f, 1.0f);
    const Float transmission = clamp(load(block.transmission + at), 0.0f, 1.0f);
    const Float roughness = clamp(load(block.roughness + at), 0.0f, 1.0f);
    const Float specular = clamp(load(block.specular + at), 0.0f, 1.0f);
    const Float ior = max(load(block.ior + at), 0.0f);
    const Float glass = (1.0f - metallic) * transmission;
    const Float opaque = (1.0f - metallic) * (1.0f - transmission);
    thin = glass > 0.0f;
    any_thin = any(thin);

    ggx = GgxLobe(roughness, max(dot(wo, ns), kMinCosine));
    row = GgxRow(tables, roughness, ggx.alpha, ggx.delta);
    const Albedo out = row.at(ggx.cos_o), mean = row.mean(tables);
    scale_o = out.scale;

    const Float root = (ior - 1.0f) / (ior + 1.0f);
    const Float3 dielectric = clamp(load(block.specular_color, at) * (root * root), 0.0f, 1.0f) * specular;
    f0 = base * metallic + dielectric * (opaque + glass);
    f90 = metallic + (opaque + glass) * specular;

    const Float most = largest(dielectric);
    const Float part = multiple_part(most + (specular - most) * kSchlickMean, mean.loss);
    multiple_f0 = dielectric * (opaque * part + glass);
    multiple_f90 = repeat((opaque * part + glass) * specular);
    const auto of_metal = [&](Float c) __attribute__((always_inline)) {
      return metallic * multiple_part(c + (1.0f - c) * kSchlickMean, mean.loss);
    };
    const Float3 metal = {of_metal(base.x), of_metal(base.y), of_metal(base.z)};
    multiple_f0 += metal * base;
    multiple_f90 += metal;
    const Float a = 1.0f - out.loss - out.b;
    albedo = f0 * a + repeat(f90 * out.b) + multiple_f0 * (1.0f - out.b_scaled - a) +
             multiple_f90 * (out.b_scaled - out.b);
    p_microfacet = luminance(albedo);

    coupling[0] = 1.0f - most;
    coupling[1] = (1.0f - part) * most;
    coupling[2] = (1.0f - part) * (most - specular);
    coupling[3] = part * (most - specular);
    const Float goes_through = clamp(load(block.diffuse_transmission + at), 0.0f, 1.0f);
    const Float coupled = kInvPi / max(passed(mean), 1e-6f);
    const Float3 diffuse_albedo = base * ((1.0f - goes_through) * opaque * passed(out));
    diffuse = diffuse_albedo * coupled;
    p_diffuse = luminance(diffuse_albedo);
    albedo += diffuse_albedo;
    p_through = 0.0f;
    through = goes_through * opaque > 0.0f;
    any_through = any(through);
    if (any_through) {
      const Float3 color =
          select_or_zero(through, clamp(load(block.diffuse_transmission_color, at), 0.0f, 1.0f));
      const Float3 transmitted = color * (goes_through * opaque * passed(out));
      diffuse_through = transmitted * coupled;
      p_through = luminance(transmitted);
      albedo += transmitted;
    }

    if (any_thin) {
      tint = base * glass;
      glass_f0 = dielectric;
      glass_f90 = specular;
      const Float3 transmitted =
          tint * (repeat(1.0f - specular * out.b_scaled) - dielectric * (1.0f - out.b_scaled));
      albedo += select_or_zero(thin, transmitted);
      p_microfacet += select_or_zero(thin, luminance(transmitted));
    }
  }

  GATELIGHT_INLINE void set_up_layers(const ShadingBlock& block, const BsdfTables& tables, int at) {
    base_scale = 1.0f;
    p_sheen = p_coat = 0.0f;
    coat.delta = no_lanes();
    sheen_color = clamp(load(block.sheen_color, at), 0.0f, 1.0f);
    has_sheen = any_positive(sheen_color);
    any_sheen = any(has_sheen);
    if (any_sheen) {
      sheen = SheenLobe(tables, clamp(load(block.sheen_roughness + at), kMinSheenRoughness, 1.0f));
      const Float reflected = sheen.lookup(1, ggx.cos_o);
      p_sheen = luminance(sheen_color) * reflected;
      base_scale = 1.0f - largest(sheen_color) * reflected;
      albedo = albedo * base_scale + sheen_color * reflected;
    }
    coat_weight = clamp(load(block.clearcoat + at), 0.0f, 1.0f);
    coated = coat_weight > 0.0f;
    any_coat = any(coated);
    if (any_coat) {
      nc = bend_normal(load(block.coat_normal, at), ng, wo);
      const Float roughness = clamp(load(block.clearcoat_roughness + at), 0.0f, 1.0f);
      coat = GgxLobe(roughness, max(dot(wo, nc), kMinCosine));
      const Albedo out = GgxRow(tables, roughness, coat.alpha, coat.delta).at(coat.cos_o);
      p_coat = coat_weight * (kCoatF0 * (1.0f - out.loss - out.b) + out.b);
      const Float kept = 1.0f - p_coat;
      albedo = albedo * kept + repeat(p_coat);
      base_scale *= kept;
      sheen_color *= kept;
      p_sheen *= kept;
    }
    p_microfacet *= base_scale;
    p_diffuse *= base_scale;
    p_through *= base_scale;
  }

  /// Bsdf::wide_part.
  GATELIGHT_INLINE void separate_wide(const BsdfTables& tables, float min_roughness) {
    const Float least = Float(min_roughness) * min_roughness;
    const auto is_wide = [&](const GgxLobe& lobe) __attribute__((always_inline)) {
      return ~(lobe.delta | (lobe.alpha2 < least * least));
    };
    wide_facets = is_wide(ggx);
    wide_coat = no_lanes();
    // The albedo of the lobes that are separate from the microfacets: wide beside narrow ones, or narrow
    // beside wide ones.
    const Float coupled = kPi * max(passed(row.mean(tables)), 1e-6f) * base_scale;
    Float3 matte = select_or_zero(p_diffuse > 0.0f, diffuse * coupled);
    if (any_through) matte += select_or_zero(p_through > 0.0f, diffuse_through * coupled);
    Float3 split = select_or_zero(~wide_facets, matte);
    if (any_sheen)
      split += select_or_zero(~wide_facets & (p_sheen > 0.0f), sheen_color * sheen.lookup(1, ggx.cos_o));
    if (any_coat) {
      wide_coat = is_wide(coat) & coated;
      const Mask differs = (wide_coat & ~wide_facets) | (~wide_coat & coated & wide_facets);
      split += repeat(select_or_zero(differs, p_coat));
    }
    split = {min(split.x, albedo.x), min(split.y, albedo.y), min(split.z, albedo.z)};
    wide_albedo = select(wide_facets, albedo - split, split);
  }

  /// Bsdf::narrow_part, except the albedo.
  GATELIGHT_INLINE void keep_narrow() {
    separates_wide = false;
    p_microfacet = select_or_zero(~wide_facets, p_microfacet);
    p_coat = select_or_zero(~wide_coat, p_coat);
    p_diffuse = p_through = p_sheen = 0.0f;
    diffuse = diffuse_through = repeat(0.0f);
  }

  GATELIGHT_INLINE Float passed(const Albedo& a) const {
    return max(0.0f, coupling[0] + coupling[1] * a.loss + coupling[2] * a.b + coupling[3] * a.b_scaled);
  }

  struct Facet {
    Float reflects;
    Float3 transmitted;
  };
  /// Bsdf::facet of thin sheets.
  GATELIGHT_INLINE Facet facet(Float cos_h) const {
    Facet result;
    const Float schlick = schlick_weight(cos_h);
    result.transmitted =
        select_or_zero(thin, tint * (repeat(1.0f - glass_f90 * schlick) - glass_f0 * (1.0f - schlick)));
    const Float r = luminance(f0 + (repeat(f90) - f0) * schlick), t = luminance(result.transmitted);
    result.reflects = select(t > 0.0f, r / (r + t), 1.0f);
    return result;
  }

  GATELIGHT_INLINE LaneValue evaluate(Float3 wi) const {
    const Float side = dot(wi, ng), cos_n = dot(wi, ns);
    const Mask front = (side > 0.0f) & (cos_n > 0.0f);
    Mask behind = no_lanes();
    Float cos_i = cos_n;
    Float3 above = wi;  // on a sheet the mirror image of the transmitted direction
    if (any_thin | any_through) {
      behind = (thin | through) & (side < 0.0f) & (cos_n < 0.0f);
      cos_i = absolute(cos_n);
      above = select(behind, wi - ns * (2.0f * cos_n), wi);
    }
    const Albedo in = row.at(max(cos_i, 0.0f));
    const Float3 h = wo + above;
    const Float h2 = dot(h, h);
    const Mask facets = ~ggx.delta & (p_microfacet > 0.0f) & (h2 > kMinHalf2);
    const GgxLobe::Terms terms = ggx.terms(ns, h, h2, cos_i);
    const Float cos_h = 0.5f * sqrt(h2);
    const Float schlick = schlick_weight(cos_h);
    const Float excess = scale_o * in.scale - 1.0f;
    const Float3 reflected =
        f0 + (repeat(f90) - f0) * schlick + (multiple_f0 + (multiple_f90 - multiple_f0) * schlick) * excess;
    const Float shape = terms.d * terms.visibility * cos_i;
    const Float chosen = p_microfacet * terms.d * ggx.pdf_scale;
    LaneValue result;
    result.value = select_or_zero(facets, reflected * shape);
    result.pdf = select_or_zero(facets, chosen);
    if (any_thin) {
      const Facet half = facet(cos_h);
      const Float balance = scale_o * in.scale;
      result.value =
          select(behind, select_or_zero(facets, half.transmitted * (shape * balance)), result.value);
      result.pdf = result.pdf * select(behind, 1.0f - half.reflects, half.reflects);
    } else if (any_through) {
      result.value = select_or_zero(~behind, result.value);
      result.pdf = select_or_zero(~behind, result.pdf);
    }
    Float3 matte = select_or_zero(front, diffuse * (passed(in) * cos_i));
    result.pdf += select_or_zero(front, p_diffuse * cos_i * kInvPi);
    if (any_through) {
      matte += select_or_zero(behind & through, diffuse_through * (passed(in) * cos_i));
      result.pdf += select_or_zero(behind & through, p_through * cos_i * kInvPi);
    }
    result.value += matte;
    const Mask valid = front | behind;
    result.value = select_or_zero(valid, result.value * base_scale);
    result.pdf = select_or_zero(valid, result.pdf);
    if (separates_wide) result.wide = select(wide_facets, result.value, matte * base_scale);
    if (any_coat) {
      const Float cos_c = dot(wi, nc);
      const Mask here = (side > 0.0f) & (p_coat > 0.0f) & ~coat.delta & (cos_c > 0.0f) & (h2 > kMinHalf2);
      const GgxLobe::Terms t = coat.terms(nc, h, h2, cos_c);
      const Float value = coat_weight * coat_fresnel(cos_h) * t.d * t.visibility * cos_c;
      result.value += repeat(select_or_zero(here, value));
      if (separates_wide) result.wide += repeat(select_or_zero(here & wide_coat, value));
      result.pdf += select_or_zero(here, p_coat * t.d * coat.pdf_scale);
    }
    if (any_sheen) {
      const Mask here = front & (p_sheen > 0.0f) & (h2 > kMinHalf2);
      const Float3 c = cross(ns, h);
      const Float value = sheen.value(dot(c, c) / h2, ggx.cos_o, max(cos_i, 0.0f)) * cos_i;
      result.value += select_or_zero(here, sheen_color * value);
      if (separates_wide) result.wide += select_or_zero(here, sheen_color * value);
      result.pdf += select_or_zero(here, p_sheen * (0.5f * kInvPi));
    }
    return result;
  }

  GATELIGHT_INLINE LaneSample sample(Float u_lobe, Float2 u) const {
    // The lobes share the unit interval in this order. Rounding leaves a remainder at its end; the last lobe
    // with a share takes it.
    const Float after_facets = p_microfacet, before_through = after_facets + p_diffuse,
                after_diffuse = before_through + p_through, after_sheen = after_diffuse + p_sheen;
    const Mask coat_has = p_coat > 0.0f, sheen_has = p_sheen > 0.0f,
               diffuse_has = (p_diffuse > 0.0f) | (p_through > 0.0f);
    const Mask facets = (u_lobe < after_facets) | ~(coat_has | sheen_has | diffuse_has);
    const Mask in_diffuse = ~facets & diffuse_has & ((u_lobe < after_diffuse) | ~(coat_has | sheen_has));
    // The diffuse directions on the other side.
    const Mask in_through =
        in_diffuse & (p_through > 0.0f) & (~(u_lobe < before_through) | ~(p_diffuse > 0.0f));
    const Mask in_sheen = ~facets & ~in_diffuse & sheen_has & ((u_lobe < after_sheen) | ~coat_has);
    const Mask in_coat = ~(facets | in_diffuse | in_sheen);

    LaneSample s;
    Float3 normal = ns, local = sample_cosine_hemisphere(u.x, u.y);
    if (any_sheen) local = select(in_sheen, sample_uniform_hemisphere(u.x, u.y), local);
    Float alpha = ggx.alpha, cos_o = ggx.cos_o;
    Mask smooth = ggx.delta;
    if (any_coat) {
      normal = select(in_coat, nc, ns);
      alpha = select(in_coat, coat.alpha, alpha);
      cos_o = select(in_coat, coat.cos_o, cos_o);
      smooth = (in_coat & coat.delta) | (~in_coat & smooth);
    }
    const Mask mirrored = facets | in_coat;
    s.delta = mirrored & smooth;
    const Frame frame(normal);
    Float3 h =
        frame.to_world(visible_normal(alpha, {dot(wo, frame.tangent), dot(wo, frame.bitangent), cos_o}, u));
    h = select(smooth, normal, h);
    s.wi = select(mirrored, mirror(wo, h), frame.to_world(local));
    s.spread = select(mirrored, select_or_zero(~smooth, alpha), 1.0f);
    if (any_through) s.wi = select(in_through, s.wi * -1.0f, s.wi);

    Mask in_pane = no_lanes();
    Facet half;
    if (any_thin) {
      const Float oh = select(smooth, ggx.cos_o, dot(wo, h));
      half = facet(oh);
      in_pane = facets & thin & ~(u_lobe / p_microfacet < half.reflects);
      const Float3 straight = s.wi - ns * (2.0f * dot(s.wi, ns));
      s.wi = select(in_pane, select(smooth, -wo, straight), s.wi);
    }
    s.transmitted = dot(s.wi, ng) < 0.0f;
    const Float towards = dot(s.wi, normal);
    const Mask passes = in_pane | in_through;
    const Mask right_side =
        (passes & s.transmitted & (towards < 0.0f)) | (~passes & ~s.transmitted & (towards > 0.0f));

    const LaneValue value = evaluate(s.wi);
    s.pdf = value.pdf;
    s.weight = value.value * (1.0f / value.pdf);
    if (separates_wide) s.wide_weight = select_or_zero(~s.delta, value.wide * (1.0f / value.pdf));
    if (any(s.delta)) {
      const Float schlick = schlick_weight(ggx.cos_o);
      const Float3 reflected = f0 + (repeat(f90) - f0) * schlick;
      Float pdf = p_microfacet;
      Float3 weight = reflected;
      if (any_thin) {
        pdf *= select(in_pane, 1.0f - half.reflects, half.reflects);
        weight = select(in_pane, half.transmitted, weight);
      }
      weight *= base_scale;
      if (any_coat) {
        pdf = select(in_coat, p_coat, pdf);
        weight = select(in_coat, repeat(coat_weight * coat_fresnel(coat.cos_o)), weight);
      }
      s.pdf = select(s.delta, pdf, s.pdf);
      s.weight = select(s.delta, weight * (1.0f / pdf), s.weight);
    }
    const Mask valid = right_side & (s.pdf > 0.0f);
    s.pdf = select_or_zero(valid, s.pdf);
    s.weight = select_or_zero(valid, s.weight);
    return s;
  }

  /// sample_visible_normal() of ggx.h.
  static GATELIGHT_INLINE Float3 visible_normal(Float alpha, Float3 local, Float2 u) {
    const Float3 stretched = normalize({alpha * local.x, alpha * local.y, local.z});
    const CosSin phi = cos_sin_turn(u.x);
    const Float z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
    const Float sine = sqrt(max(0.0f, 1.0f - z * z));
    return normalize({alpha * (sine * phi.cos + stretched.x), alpha * (sine * phi.sin + stretched.y),
                      max(z + stretched.z, 1e-7f)});
  }
};

}  // namespace
