#include "renderer/bsdf/bsdf.h"

#include <algorithm>
#include <cmath>

#include "renderer/bsdf/fresnel.h"

namespace gatelight::renderer {
namespace {

/// Rough boundaries with a smaller difference of the indices transmit light unrefracted. The half vector of a
/// refraction would suffer from cancellation, and the microfacet model loses most of the light there.
constexpr float kMinRoughIorStep = 0.02f;

/// Bends n towards ng until the mirror direction of wo is above the surface. The new n is half-way between wo
/// and the lifted mirror direction, so wo is above its horizon too.
Vec3 bend_normal(const Vec3& n, const Vec3& ng, const Vec3& wo) {
  const float on = wo.dot(n);
  const float og = std::max(wo.dot(ng), 0.0f);
  const float mirrored = 2.0f * on * n.dot(ng) - og;
  const float lifted = std::min(0.9f * og, 0.01f);
  if (mirrored >= lifted && on > 0.0f) return n;
  const float tangent2 = 1.0f - mirrored * mirrored;
  if (!(tangent2 > 1e-6f)) return ng;
  const float stretch = std::sqrt((1.0f - lifted * lifted) / tangent2);
  const Vec3 tangent = 2.0f * on * n - wo - mirrored * ng;
  const Vec3 half = wo + stretch * tangent + lifted * ng;
  const float length2 = half.squaredNorm();
  return length2 > 1e-8f ? Vec3(half / std::sqrt(length2)) : ng;
}

/// The part of the light lost by single scattering that leaves after more scattering, divided by the mean
/// reflectance: one more reflection, then a geometric series (Hill 2018).
template <class T>
T multiple_part(const T& mean_fresnel, float mean_loss) {
  return mean_fresnel * (1.0f - mean_loss) / (1.0f - mean_fresnel * mean_loss);
}

float schlick_mean(float f0, float f90) {
  return f0 + (f90 - f0) * kSchlickMean;
}

Color schlick_mean(const Color& f0, float f90) {
  return f0 + (f90 - f0) * kSchlickMean;
}

}  // namespace

Bsdf::Bsdf(const SurfaceMaterial& material, const Vec3& ng, const Vec3& ns, const Vec3& nc, const Vec3& wo,
           bool front)
    : wo_(wo), ng_(ng), ns_(bend_normal(ns, ng, wo)) {
  set_up_base(material, front);
  const bool inside = glass_ == Glass::refracting && !front;
  if (!inside && (material.clearcoat > 0.0f || (material.sheen_color > 0.0f).any())) {
    nc_ = bend_normal(nc, ng, wo);
    set_up_layers(material);
  }
  // Interpolation in the tables can overshoot by some tenths of a percent.
  albedo_ = albedo_.max(0.0f).min(1.0f);
  // A lobe with a value needs a probability above zero, even if its albedo is tiny.
  p_microfacet_ = std::max(p_microfacet_, 1e-3f * f90_ * base_scale_);
  normalize_chances();
}

void Bsdf::normalize_chances() {
  float* const probabilities[] = {&p_microfacet_, &p_diffuse_,      &p_diffuse_through_,
                                  &p_clear_,      &p_loss_reflect_, &p_loss_transmit_,
                                  &p_coat_,       &p_sheen_};
  float total = 0.0f;
  for (const float* p : probabilities) total += *p;
  const float scale = total > 0.0f ? 1.0f / total : 0.0f;
  for (float* p : probabilities) *p *= scale;
  is_delta_ = p_diffuse_ == 0.0f && p_diffuse_through_ == 0.0f && p_sheen_ == 0.0f &&
              (ggx_.delta || p_microfacet_ == 0.0f) && (p_coat_ == 0.0f || coat_.delta);
}

/// The clamped parameters of the base, and terms that its lobes share.
struct Bsdf::Base {
  Color color;
  float metallic, roughness, specular, ior;
  float glass, opaque;  ///< shares of the base; the rest is metal
  float ior_f0 = 0.0f;
  Color f0;  ///< of the dielectric
  float largest_f0 = 0.0f;
  float part = 0.0f;  ///< multiple_part() of the dielectric
  GgxAlbedo out, mean;

  explicit Base(const SurfaceMaterial& material)
      : color(material.base_color.max(0.0f).min(1.0f)),
        metallic(std::clamp(material.metallic, 0.0f, 1.0f)),
        roughness(std::clamp(material.roughness, 0.0f, 1.0f)),
        specular(std::clamp(material.specular, 0.0f, 1.0f)),
        ior(std::max(material.ior, 0.0f)) {
    const float transmission = std::clamp(material.transmission, 0.0f, 1.0f);
    glass = (1.0f - metallic) * transmission;
    opaque = (1.0f - metallic) * (1.0f - transmission);
  }
};

void Bsdf::set_up_base(const SurfaceMaterial& material, bool front) {
  Base base(material);
  if (base.glass > 0.0f) choose_glass(base, material.thin_walled, front);
  set_up_facets(base, material);
  set_up_reflection(base, material);
  // The diffuse base receives and emits only light that the dielectric transmits.
  if (base.opaque > 0.0f) set_up_diffuse(base, material);
  if (glass_ != Glass::none) set_up_glass(base);
}

void Bsdf::choose_glass(const Base& base, bool thin_walled, bool front) {
  if (thin_walled || base.ior == 0.0f) {
    glass_ = Glass::thin;
    return;
  }
  const bool bends = base.roughness < kDeltaRoughness || std::abs(base.ior - 1.0f) >= kMinRoughIorStep;
  glass_ = bends ? Glass::refracting : Glass::clear;
  eta_ = front ? base.ior : 1.0f / base.ior;
  transmit_scale_ = 1.0f / (eta_ * eta_);
}

void Bsdf::set_up_facets(Base& base, const SurfaceMaterial& material) {
  ggx_ = GgxLobe(base.roughness * base.roughness, std::max(wo_.dot(ns_), kMinCosine));
  const float anisotropy = glass_ == Glass::refracting ? 0.0f : std::clamp(material.anisotropy, 0.0f, 1.0f);
  if (anisotropy > 0.0f) {
    anisotropic_.emplace(base.roughness, anisotropy, material.anisotropy_direction, ns_);
    // The lobe counts as narrow if its narrower side is.
    ggx_ = GgxLobe(anisotropic_->alpha_y, ggx_.cos_o);
    ggx_.delta = false;
    ggx_.root_o = anisotropic_->root(wo_);
    ggx_.pdf_scale = 0.5f / (ggx_.cos_o + ggx_.root_o);
  } else if (!ggx_.delta) {
    row_ = GgxTables::get().row(base.roughness);
  }
  base.out = facets_albedo(wo_, ggx_.cos_o);
  base.mean = mean_albedo();
  scale_o_ = base.out.scale;
}

void Bsdf::set_up_reflection(Base& base, const SurfaceMaterial& material) {
  // KHR_materials_specular: the colour scales f0, the factor scales f0 and f90.
  base.ior_f0 = dielectric_f0(base.ior);
  base.f0 = (base.ior_f0 * material.specular_color).max(0.0f).min(1.0f) * base.specular;
  const auto& [color, metallic, roughness, specular, ior, glass, opaque, ior_f0, f0, largest_f0, part, out,
               mean] = base;
  const float thin = glass_ == Glass::thin ? glass : 0.0f;
  f0_ = metallic * color + (opaque + thin) * f0;
  f90_ = metallic + (opaque + thin) * specular;

  // The largest channel decides, so that a tinted layer does not give the base its complementary colour.
  base.largest_f0 = f0.maxCoeff();
  base.part = multiple_part(schlick_mean(largest_f0, specular), mean.loss);
  // A sheet transmits all that it does not reflect, so nothing is lost.
  multiple_f0_ = (opaque * part + thin) * f0;
  multiple_f90_.setConstant((opaque * part + thin) * specular);
  if (metallic > 0.0f) {
    const Color metal_part = metallic * multiple_part(schlick_mean(color, 1.0f), mean.loss);
    multiple_f0_ += metal_part * color;
    multiple_f90_ += metal_part;
  }
  if (material.iridescence > 0.0f) {
    film_ = {{std::min(material.iridescence, 1.0f), std::max(material.film_ior, 1.0f),
              std::max(material.film_thickness, 0.0f), material.clearcoat > 0.0f ? kCoatIor : 1.0f},
             color,
             f0,
             specular,
             metallic,
             opaque + thin};
  }
  const float a = 1.0f - out.loss - out.b;
  albedo_ = f0_ * a + f90_ * out.b + multiple_f0_ * (1.0f - out.b_scaled - a) +
            multiple_f90_ * (out.b_scaled - out.b);
  if (film_) albedo_ = (albedo_ + film_change(ggx_.cos_o) * (1.0f - out.loss)).max(0.0f);
  p_microfacet_ = luminance(albedo_);
}

void Bsdf::set_up_diffuse(const Base& base, const SurfaceMaterial& material) {
  const float part = base.part, largest_f0 = base.largest_f0;
  coupling_[0] = 1.0f - largest_f0;
  coupling_[1] = (1.0f - part) * largest_f0;
  coupling_[2] = (1.0f - part) * (largest_f0 - base.specular);
  coupling_[3] = part * (largest_f0 - base.specular);
  // Only 1 / eta^2 of the light from all directions of a denser medium leaves it.
  const float through =
      std::clamp(material.diffuse_transmission, 0.0f, 1.0f) / std::max(transmit_scale_, 1.0f);
  mean_passed_ = std::max(passed(base.mean), 1e-6f);
  if (film_) {
    mean_passed_ = 1e-6f;
    constexpr int kSteps = 8;
    for (int i = 0; i < kSteps; ++i) {
      const float x = (static_cast<float>(i) + 0.5f) / kSteps, cosine = x * x;
      const GgxAlbedo albedo = anisotropic_ ? anisotropic_->row.at(cosine, 0.5f) : row_.at(cosine);
      mean_passed_ += passed(albedo, cosine) * (4.0f * x * x * x / kSteps);
    }
  }
  const float coupled = kInvPi / mean_passed_;
  const float passed_out = passed(base.out, ggx_.cos_o);
  const Color diffuse_albedo = base.color * ((1.0f - through) * base.opaque * passed_out);
  diffuse_ = diffuse_albedo * coupled;
  p_diffuse_ = luminance(diffuse_albedo);
  albedo_ += diffuse_albedo;
  if (!(through > 0.0f)) return;
  lets_through_ = true;
  const Color color = material.diffuse_transmission_color.max(0.0f).min(1.0f);
  const Color transmitted = color * (through * base.opaque * passed_out);
  diffuse_through_ = transmitted * (coupled * transmit_scale_);
  p_diffuse_through_ = luminance(transmitted);
  albedo_ += transmitted;
}

void Bsdf::set_up_glass(const Base& base) {
  glass_weight_ = base.glass;
  glass_tint_ = base.glass * base.color;
  glass_f0_ = base.f0;
  glass_f90_ = base.specular;
  if (glass_ == Glass::clear) {
    albedo_ += glass_tint_;
    p_clear_ = luminance(glass_tint_);
  } else if (glass_ == Glass::thin) {
    eta_ = 1.0f;
    Color transmitted =
        glass_tint_ * (1.0f - base.f0 * (1.0f - base.out.b_scaled) - base.specular * base.out.b_scaled);
    if (film_) transmitted = (transmitted - glass_tint_ * film_on_dielectric(ggx_.cos_o)).max(0.0f);
    albedo_ += transmitted;
    p_microfacet_ += luminance(transmitted);
  } else {
    set_up_refraction(base.roughness, base.ior_f0);
  }
}

void Bsdf::set_up_refraction(float roughness, float ior_f0) {
  fresnel_base_ = ior_f0;
  const Facet perpendicular = facet(ggx_.cos_o);
  if (ggx_.delta) {
    const Color added = perpendicular.reflected + perpendicular.transmitted;
    albedo_ += added;
    p_microfacet_ += luminance(added);
    return;
  }
  const GlassTables& tables = GlassTables::get();
  glass_here_ = tables.rows(roughness, eta_);
  glass_there_ = tables.rows(roughness, 1.0f / eta_);
  const float k = glass_f90_;
  const GlassAlbedo out = glass_here_.at(ggx_.cos_o);
  // The reflectance of the smooth interface, scaled to the power that is not lost, plus the difference from
  // the table.
  const Color reflected_once =
      (perpendicular.reflected * (1.0f - out.lost) + glass_weight_ * (k * out.reflected + out.total))
          .max(0.0f)
          .min(glass_weight_ * (1.0f - out.loss(k)));
  const Color single =
      reflected_once + glass_tint_ * (1.0f - out.loss(k) - reflected_once * (1.0f / glass_weight_));
  albedo_ += single;
  p_microfacet_ += luminance(single);

  const float mean_here = glass_here_.mean_loss(k);
  const float mean_there = glass_there_.mean_loss(k);
  const float loss = out.loss(k);
  if (!(loss > 0.0f && mean_here > 0.0f && mean_there > 0.0f)) return;
  // `part` of the loss leaves on the other side. This is reciprocal if part * mean loss here is eta^2 times
  // part * mean loss there. The mean Fresnel transmittances already have the ratio eta^2.
  const float smooth =
      eta_ > 1.0f ? 1.0f - glass_here_.mean_fresnel(k) : eta_ * eta_ * (1.0f - glass_there_.mean_fresnel(k));
  const float part = std::clamp(smooth * mean_there / std::max(mean_here, mean_there), 0.0f, 1.0f);
  const float reflected = glass_weight_ * (1.0f - part) * loss;
  const Color transmitted = glass_tint_ * (part * loss);
  glass_multiple_reflect_ = reflected * kInvPi / mean_here;
  glass_multiple_transmit_ = transmitted * (kInvPi / (mean_there * eta_ * eta_));
  albedo_ += reflected + transmitted;
  p_loss_reflect_ = reflected;
  p_loss_transmit_ = luminance(transmitted);
  loss_lobe_ = LossLobe(roughness * roughness);
}

void Bsdf::set_up_layers(const SurfaceMaterial& material) {
  has_layers_ = true;
  const Color sheen = material.sheen_color.max(0.0f).min(1.0f);
  sheen_color_ = sheen;
  if ((sheen > 0.0f).any()) {
    const float roughness = std::clamp(material.sheen_roughness, kMinSheenRoughness, 1.0f);
    sheen_ = SheenLobe(roughness, SheenTables::get().row(roughness));
    const float reflected = sheen_.row.albedo(ggx_.cos_o);
    p_sheen_ = luminance(sheen) * reflected;
    base_scale_ = 1.0f - sheen.maxCoeff() * reflected;
    albedo_ = albedo_ * base_scale_ + sheen * reflected;
  }
  const float base_scale = base_scale_;
  float coat_scale = 1.0f;
  coat_weight_ = std::clamp(material.clearcoat, 0.0f, 1.0f);
  if (coat_weight_ > 0.0f) {
    const float roughness = std::clamp(material.clearcoat_roughness, 0.0f, 1.0f);
    coat_ = GgxLobe(roughness * roughness, std::max(wo_.dot(nc_), kMinCosine));
    const GgxTables::Row row = coat_.delta ? GgxTables::Row() : GgxTables::get().row(roughness);
    coat_albedo_ = coat_weight_ * row.at(coat_.cos_o).reflect(kCoatF0, 1.0f);
    p_coat_ = coat_albedo_;
    coat_scale = 1.0f - p_coat_;
    albedo_ = albedo_ * coat_scale + p_coat_;
    base_scale_ *= coat_scale;
    sheen_color_ *= coat_scale;
    p_sheen_ *= coat_scale;
  }
  p_microfacet_ *= base_scale * coat_scale;
  p_diffuse_ *= base_scale * coat_scale;
  p_diffuse_through_ *= base_scale * coat_scale;
  p_clear_ *= base_scale * coat_scale;
  p_loss_reflect_ *= base_scale * coat_scale;
  p_loss_transmit_ *= base_scale * coat_scale;
}

}  // namespace gatelight::renderer
