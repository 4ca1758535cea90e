// Chooses a lobe and a direction in it.

#include <algorithm>
#include <cmath>

#include "renderer/bsdf/bsdf.h"
#include "renderer/bsdf/fresnel.h"

namespace gatelight::renderer {
namespace {

Vec3 mirror(const Vec3& wo, const Vec3& n) {
  return 2.0f * wo.dot(n) * n - wo;
}

/// The result is normalised. Refraction out of a dense medium multiplies the error of wo's length by the
/// square of the index.
Vec3 refracted(const Vec3& wo, const Vec3& n, float cos_o, float cos_t, float eta) {
  const Vec3 wi = (cos_o / eta - cos_t) * n - wo / eta;
  return wi / wi.norm();
}

BsdfSample delta_sample(const Vec3& wi, const Color& weight, float pdf, bool transmitted) {
  return {.wi = wi, .weight = weight, .pdf = pdf, .delta = true, .transmitted = transmitted, .spread = 0.0f};
}

/// A visible normal of a lobe, in world space.
Vec3 sample_half(const GgxLobe& lobe, const Vec3& normal, const Vec3& wo, const Vec2& u) {
  const Basis basis(normal);
  const Vec3 local(wo.dot(basis.tangent), wo.dot(basis.bitangent), lobe.cos_o);
  return basis.to_world(sample_visible_normal(std::sqrt(lobe.alpha2), local, u));
}

}  // namespace

BsdfSample Bsdf::sample(float u_lobe, const Vec2& u) const {
  float rest = u_lobe;
  // Takes a lobe if the number falls into its share. Also takes it if only a rounding error remains for later
  // lobes.
  float later = 1.0f - p_microfacet_;
  const auto takes = [&](float p) {
    later -= p;
    if (p > 0.0f && (rest < p || later < 1e-6f)) return true;
    rest -= p;
    return false;
  };
  if (rest < p_microfacet_) return sample_microfacet(rest / p_microfacet_, u);
  rest -= p_microfacet_;
  if (takes(p_diffuse_)) return finish(Basis(ns_).to_world(sample_cosine_hemisphere(u)), ns_, 1.0f);
  if (takes(p_diffuse_through_)) return finish(-Basis(ns_).to_world(sample_cosine_hemisphere(u)), -ns_, 1.0f);
  if (takes(p_loss_reflect_)) return finish(Basis(ns_).to_world(loss_lobe_.sample(u)), ns_, 1.0f);
  if (takes(p_loss_transmit_)) return finish(-Basis(ns_).to_world(loss_lobe_.sample(u)), -ns_, 1.0f);
  if (takes(p_sheen_)) return finish(Basis(ns_).to_world(sample_uniform_hemisphere(u)), ns_, 1.0f);
  if (takes(p_clear_)) {
    BsdfSample sample =
        delta_sample(-wo_, glass_tint_ * (base_scale_ * transmit_scale_ / p_clear_), p_clear_, true);
    sample.radiance_scale = transmit_scale_;
    return sample;
  }
  if (p_coat_ > 0.0f) {
    if (!coat_.delta) {
      return finish(mirror(wo_, sample_half(coat_, nc_, wo_, u)), nc_, std::sqrt(coat_.alpha2));
    }
    const Vec3 wi = mirror(wo_, nc_);
    if (!(wi.dot(ng_) > 0.0f)) return {};
    const float reflected = coat_weight_ * coat_fresnel(coat_.cos_o);
    return delta_sample(wi, Color::Constant(reflected / p_coat_), p_coat_, false);
  }
  if (p_microfacet_ > 0.0f) return sample_microfacet(1.0f - 0x1p-24f, u);
  return {};
}

BsdfSample Bsdf::sample_microfacet(float u_lobe, const Vec2& u) const {
  if (ggx_.delta) {
    const Facet half = facet(ggx_.cos_o);
    return sample_delta(u_lobe >= half.probability_reflect, half);
  }
  const Vec3 h =
      anisotropic_ ? anisotropic_->sample_half(wo_, ggx_.cos_o, u) : sample_half(ggx_, ns_, wo_, u);
  const float spread =
      anisotropic_ ? std::sqrt(anisotropic_->alpha_x * anisotropic_->alpha_y) : std::sqrt(ggx_.alpha2);
  if (glass_ == Glass::none || glass_ == Glass::clear) return finish(mirror(wo_, h), ns_, spread);
  const float oh = wo_.dot(h);
  if (!(oh > 0.0f)) return {};
  const Facet half = facet(oh);
  if (u_lobe < half.probability_reflect) return finish(mirror(wo_, h), ns_, spread);
  if (glass_ == Glass::thin) {
    const Vec3 reflected = mirror(wo_, h);
    return finish(reflected - 2.0f * reflected.dot(ns_) * ns_, -ns_, spread);
  }
  return finish(refracted(wo_, h, oh, half.cos_t, eta_), -ns_, spread);
}

BsdfSample Bsdf::sample_delta(bool transmitted, const Facet& half) const {
  if (!transmitted) {
    const Vec3 wi = mirror(wo_, ns_);
    if (!(wi.dot(ng_) > 0.0f)) return {};
    const float pdf = p_microfacet_ * half.probability_reflect;
    Color reflected = f0_ + (f90_ - f0_) * half.schlick + half.reflected;
    if (film_) reflected = (reflected + film_change(ggx_.cos_o)).max(0.0f);
    return delta_sample(wi, reflected * (base_scale_ / pdf), pdf, false);
  }
  const bool thin = glass_ == Glass::thin;
  const Vec3 wi = thin ? Vec3(-wo_) : refracted(wo_, ns_, ggx_.cos_o, half.cos_t, eta_);
  const float pdf = p_microfacet_ * (1.0f - half.probability_reflect);
  if (!(wi.dot(ng_) < 0.0f) || !(pdf > 0.0f)) return {};
  BsdfSample sample = delta_sample(wi, half.transmitted * (base_scale_ * transmit_scale_ / pdf), pdf, true);
  sample.radiance_scale = transmit_scale_;
  return sample;
}

BsdfSample Bsdf::finish(const Vec3& wi, const Vec3& normal, float spread) const {
  BsdfSample sample;
  sample.wi = wi;
  // A direction on the wrong side has no weight. It must not count as a sample of another lobe.
  sample.transmitted = wi.dot(ng_) < 0.0f;
  const bool behind = normal.dot(ng_) < 0.0f;
  if (!(wi.dot(normal) > 0.0f) || sample.transmitted != behind) return sample;
  const BsdfValue value = evaluate(wi);
  if (!(value.pdf > 0.0f)) return sample;
  sample.weight = value.value / value.pdf;
  sample.pdf = value.pdf;
  if (sample.transmitted) sample.radiance_scale = transmit_scale_;
  sample.spread = spread;
  return sample;
}

}  // namespace gatelight::renderer
