// Surfaces with only some of the lobes. A lobe with probability zero is not evaluated. So a part is a copy in
// which the other lobes have probability zero. The interactions of the lobes (the coupling of the diffuse
// base, the scales of the layers) stay those of the whole.

#include <algorithm>

#include "renderer/bsdf/bsdf.h"

namespace gatelight::renderer {
namespace {

/// alpha^2 is the fourth power of the perceptual roughness. It is computed by the same products as in the
/// lobe, so that a lobe is never narrower than its own roughness.
bool is_narrow(const GgxLobe& lobe, float roughness) {
  const float alpha = roughness * roughness;
  return lobe.delta || lobe.alpha2 < alpha * alpha;
}

}  // namespace

bool Bsdf::has(float roughness, bool narrow) const {
  const float microfacets = p_microfacet_ + p_loss_reflect_ + p_loss_transmit_;
  return (narrow ? p_clear_ > 0.0f : p_diffuse_ > 0.0f || p_diffuse_through_ > 0.0f || p_sheen_ > 0.0f) ||
         (microfacets > 0.0f && is_narrow(ggx_, roughness) == narrow) ||
         (p_coat_ > 0.0f && is_narrow(coat_, roughness) == narrow);
}

Color Bsdf::diffuse_albedo() const {
  Color both = Color::Zero();
  if (p_diffuse_ > 0.0f) both += diffuse_;
  // The albedo leaves the radiance scale of refraction out.
  if (p_diffuse_through_ > 0.0f) both += diffuse_through_ / transmit_scale_;
  return both * (kPi * mean_passed_ * base_scale_);
}

Color Bsdf::sheen_albedo() const {
  if (!(p_sheen_ > 0.0f)) return Color::Zero();
  return sheen_color_ * sheen_.row.albedo(ggx_.cos_o);
}

Bsdf Bsdf::part(float roughness, bool narrow) const {
  const bool narrow_facets = is_narrow(ggx_, roughness);
  const bool narrow_coat = is_narrow(coat_, roughness);
  const bool keeps_facets = narrow_facets == narrow;
  // The albedo of the part without the microfacets. The other part has the rest.
  Color split = Color::Zero();
  if (narrow_facets) {
    split += diffuse_albedo() + sheen_albedo();
  } else if (p_clear_ > 0.0f) {
    split += glass_tint_ * base_scale_;
  }
  if (p_coat_ > 0.0f && narrow_coat != narrow_facets) split += coat_albedo_;
  split = split.min(albedo_);

  Bsdf result = *this;
  if (!keeps_facets) result.p_microfacet_ = result.p_loss_reflect_ = result.p_loss_transmit_ = 0.0f;
  if (narrow) {
    result.p_diffuse_ = result.p_diffuse_through_ = result.p_sheen_ = 0.0f;
    result.lets_through_ = false;
  } else {
    result.p_clear_ = 0.0f;
  }
  if (narrow_coat != narrow) result.p_coat_ = 0.0f;
  const bool keeps_glass = glass_ == Glass::clear ? narrow : keeps_facets;
  if (!keeps_glass) result.glass_ = Glass::none;
  result.albedo_ = keeps_facets ? Color(albedo_ - split) : split;
  // A remainder from rounding is not light.
  if (!has(roughness, narrow)) result.albedo_.setZero();
  result.normalize_chances();
  return result;
}

}  // namespace gatelight::renderer
