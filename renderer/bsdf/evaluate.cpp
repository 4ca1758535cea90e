// Values and pdfs of the lobes for a given wi.

#include <algorithm>
#include <cmath>

#include "renderer/bsdf/bsdf.h"
#include "renderer/bsdf/fresnel.h"

namespace gatelight::renderer {

Bsdf::Facet Bsdf::facet(float cos_h) const {
  Facet result;
  result.schlick = schlick_weight(cos_h);
  if (glass_ == Glass::thin) {
    result.transmitted = glass_tint_ * (1.0f - glass_f0_ - (glass_f90_ - glass_f0_) * result.schlick);
    if (film_) result.transmitted = (result.transmitted - glass_tint_ * film_on_dielectric(cos_h)).max(0.0f);
  } else if (glass_ == Glass::refracting) {
    // The exact curve from f0 to f90 replaces Schlick's (1 - c)^5. At total internal reflection nothing is
    // transmitted, for any specular factor.
    const float exact = fresnel_dielectric(cos_h, eta_, result.cos_t);
    if (result.cos_t > 0.0f) {
      const float curve = std::max(0.0f, (exact - fresnel_base_) / (1.0f - fresnel_base_));
      Color reflected = glass_f0_ + (glass_f90_ - glass_f0_) * curve;
      // The angle outside, on whichever side wo is.
      if (film_)
        reflected = (reflected + film_on_dielectric(eta_ > 1.0f ? cos_h : result.cos_t)).max(0.0f).min(1.0f);
      result.reflected = glass_weight_ * reflected;
      result.transmitted = glass_tint_ * (1.0f - reflected);
    } else {
      result.reflected.setConstant(glass_weight_);
    }
  } else {
    return result;
  }
  Color reflected = f0_ + (f90_ - f0_) * result.schlick + result.reflected;
  if (film_) reflected = (reflected + film_change(cos_h)).max(0.0f);
  const float r = luminance(reflected);
  const float t = luminance(result.transmitted);
  result.probability_reflect = t > 0.0f ? r / (r + t) : 1.0f;
  return result;
}

Color Bsdf::film_change(float cosine) const {
  const FilmOnBase& f = *film_;
  Color change = Color::Zero();
  if (f.metallic > 0.0f) change += f.metallic * f.film.change(cosine, f.metal_f0, 1.0f);
  if (f.dielectric > 0.0f) change += f.dielectric * film_on_dielectric(cosine);
  return change;
}

float Bsdf::film_passed(const GgxAlbedo& albedo, float cosine) const {
  return std::max(0.0f, passed(albedo) - film_on_dielectric(cosine).maxCoeff() * (1.0f - albedo.loss));
}

Color Bsdf::unrefracted_transmittance() const {
  if (glass_ != Glass::thin || !ggx_.delta) return Color::Zero();
  return facet(ggx_.cos_o).transmitted * base_scale_;
}

BsdfValue Bsdf::evaluate(const Vec3& wi) const {
  BsdfValue result;
  const float side = wi.dot(ng_);
  const float cos_i = wi.dot(ns_);
  if (side > 0.0f) {
    if (cos_i > 0.0f) add_reflection(wi, cos_i, result);
    if (has_layers_) {
      result.value *= base_scale_;
      add_layers(wi, result);
    }
  } else if (side < 0.0f && cos_i < 0.0f && transmits()) {
    add_transmission(wi, -cos_i, result);
    result.value *= base_scale_;
  }
  return result;
}

void Bsdf::add_reflection(const Vec3& wi, float cos_i, BsdfValue& result) const {
  const GgxAlbedo in = facets_albedo(wi, cos_i);
  if (!ggx_.delta && p_microfacet_ > 0.0f) {
    const Vec3 h = wo_ + wi;
    const float h2 = h.squaredNorm();
    if (h2 > kMinHalf2) {
      const GgxLobe::Terms terms = facets_terms(h, h2, wi, cos_i);
      const float cos_h = 0.5f * std::sqrt(h2);
      const float excess = scale_o_ * in.scale - 1.0f;
      const float schlick = schlick_weight(cos_h);
      Color reflected =
          f0_ + (f90_ - f0_) * schlick + excess * (multiple_f0_ + (multiple_f90_ - multiple_f0_) * schlick);
      if (film_) reflected = (reflected + film_change(cos_h)).max(0.0f);
      float pdf = p_microfacet_ * terms.d * ggx_.pdf_scale;
      if (glass_ == Glass::thin || glass_ == Glass::refracting) {
        const Facet half = facet(cos_h);
        reflected += half.reflected;
        pdf *= half.probability_reflect;
      }
      result.value += reflected * (terms.d * terms.visibility * cos_i);
      result.pdf += pdf;
    }
  }
  if (p_loss_reflect_ > 0.0f) {
    result.value += glass_multiple_reflect_ * glass_here_.loss_at(cos_i, glass_f90_) * cos_i;
    result.pdf += p_loss_reflect_ * loss_lobe_.pdf(cos_i);
  }
  if (p_diffuse_ > 0.0f) {
    result.value += diffuse_ * (passed(in, cos_i) * cos_i);
    result.pdf += p_diffuse_ * cos_i * kInvPi;
  }
}

void Bsdf::add_transmission(const Vec3& wi, float cos_i, BsdfValue& result) const {
  if (p_diffuse_through_ > 0.0f) {
    result.value += diffuse_through_ * (passed(facets_albedo(wi, cos_i), cos_i) * cos_i);
    result.pdf += p_diffuse_through_ * cos_i * kInvPi;
  }
  if (glass_ == Glass::none || glass_ == Glass::clear || ggx_.delta || !(p_microfacet_ > 0.0f)) return;
  if (glass_ == Glass::thin) {
    // The reflection lobe, mirrored to the other side of the sheet.
    const Vec3 mirrored = wi + 2.0f * cos_i * ns_;
    const Vec3 h = wo_ + mirrored;
    const float h2 = h.squaredNorm();
    if (!(h2 > kMinHalf2)) return;
    const GgxLobe::Terms terms = facets_terms(h, h2, mirrored, cos_i);
    const Facet half = facet(0.5f * std::sqrt(h2));
    const float scale = scale_o_ * facets_albedo(wi, cos_i).scale;
    result.value += half.transmitted * (terms.d * terms.visibility * cos_i * scale);
    result.pdf += p_microfacet_ * terms.d * ggx_.pdf_scale * (1.0f - half.probability_reflect);
    return;
  }
  if (p_loss_transmit_ > 0.0f) {
    result.value += glass_multiple_transmit_ * (glass_there_.loss_at(cos_i, glass_f90_) * cos_i);
    result.pdf += p_loss_transmit_ * loss_lobe_.pdf(cos_i);
  }
  // Walter et al. 2007, equations 16, 17 and 21. The half vector -(wo + eta wi) points to the side of the
  // lower index. Turned to the side of wo, it must have wo above its plane and wi below.
  Vec3 h = wo_ + eta_ * wi;
  if (h.dot(ns_) < 0.0f) h = -h;
  const float h2 = h.squaredNorm();
  const float oh = wo_.dot(h);
  const float ih = wi.dot(h);
  if (!(h2 > kMinHalf2 && oh > 0.0f && ih < 0.0f)) return;
  const float length = std::sqrt(h2);
  const GgxLobe::Terms terms = ggx_.terms(ns_, h, h2, cos_i);
  const Facet half = facet(std::min(1.0f, oh / length));
  // |dh / dwi| without its factor eta^2, which the radiance scale cancels.
  const float jacobian = -ih / (length * h2);
  const float visible = 4.0f * (oh / length) * jacobian;
  result.value += half.transmitted * (terms.d * terms.visibility * cos_i * visible);
  result.pdf +=
      p_microfacet_ * (1.0f - half.probability_reflect) * terms.d * ggx_.pdf_scale * visible * (eta_ * eta_);
}

void Bsdf::add_layers(const Vec3& wi, BsdfValue& result) const {
  const Vec3 h = wo_ + wi;
  const float h2 = h.squaredNorm();
  if (!(h2 > kMinHalf2)) return;
  if (p_coat_ > 0.0f && !coat_.delta) {
    const float cos_i = wi.dot(nc_);
    if (cos_i > 0.0f) {
      const GgxLobe::Terms terms = coat_.terms(nc_, h, h2, cos_i);
      const float fresnel = coat_fresnel(0.5f * std::sqrt(h2));
      result.value += coat_weight_ * fresnel * terms.d * terms.visibility * cos_i;
      result.pdf += p_coat_ * terms.d * coat_.pdf_scale;
    }
  }
  if (p_sheen_ > 0.0f) {
    const float cos_i = wi.dot(ns_);
    if (cos_i > 0.0f) {
      const float sin2_h = ns_.cross(h).squaredNorm() / h2;
      result.value += sheen_color_ * (sheen_.value(sin2_h, ggx_.cos_o, cos_i) * cos_i);
      result.pdf += p_sheen_ * pdf_uniform_hemisphere();
    }
  }
}

}  // namespace gatelight::renderer
