#pragma once
// The glTF metallic-roughness material with its extensions, at one surface point and for one outgoing
// direction.
//
// Conventions for all functions: directions are unit vectors in world space and point away from the surface.
// The geometric normal `ng` lies on the side of `wo`. Values include the cosine: evaluate() returns f *
// |cos(ns, wi)|, and the weight of a sample is f * |cos| / pdf. Pdfs are per solid angle. Delta lobes are
// zero in evaluate(). Light is reflected only where wi is on the side of ng, and transmitted only where wi is
// on the other side. The shading normal does not change this, so normal maps never leak light.
//
// Values are for radiance along camera paths. Light that is refracted from a medium of index n_i into the
// medium of wo, of index n_o, is scaled by (n_o / n_i)^2 in addition to the transmitted power. A path that
// enters a medium and leaves it has the scales 1 / eta^2 and eta^2. README.md has the equations and their
// sources.

#include <cstdint>
#include <optional>

#include "base/math.h"
#include "renderer/bsdf/anisotropic.h"
#include "renderer/bsdf/ggx.h"
#include "renderer/bsdf/glass_tables.h"
#include "renderer/bsdf/sheen.h"
#include "renderer/bsdf/tables.h"
#include "renderer/bsdf/thin_film.h"

namespace gatelight::renderer {

/// All parameters of the lobes, with textures and vertex colours applied.
struct SurfaceMaterial {
  Color base_color{1.0f, 1.0f, 1.0f};
  float metallic = 0.0f;
  float roughness = 1.0f;  ///< perceptual; GGX alpha is its square
  float ior = 1.5f;        ///< of the inside; 0 means a Fresnel reflectance of 1 (KHR_materials_ior)
  float specular = 1.0f;
  Color specular_color{1.0f, 1.0f, 1.0f};
  float transmission = 0.0f;
  bool thin_walled = true;  ///< a thin sheet: transmission does not refract
  // All members from here on are zero by default, so that they are cleared together. Few surfaces set them.
  float dispersion = 0.0f;  ///< of `ior`, for the path that chooses a wavelength (sampling/wavelength.h)
  float diffuse_transmission = 0.0f;  ///< the share of the diffuse light that leaves on the other side
  Color diffuse_transmission_color{0.0f, 0.0f, 0.0f};
  float iridescence = 0.0f;     ///< KHR_materials_iridescence: the factor
  float film_ior = 0.0f;        ///< used only where there is a film
  float film_thickness = 0.0f;  ///< nanometres
  /// In [0, 1]: GGX alpha grows with its square from that of the roughness to 1 along `anisotropic`, a unit
  /// vector in world space across the normal. Refraction does not follow it.
  float anisotropy = 0.0f;
  Vec3 anisotropy_direction{0.0f, 0.0f, 0.0f};
  float clearcoat = 0.0f;
  float clearcoat_roughness = 0.0f;
  Color sheen_color{0.0f, 0.0f, 0.0f};
  float sheen_roughness = 0.0f;
};

/// Where one of these is above zero, the surface has a lobe that the kernels of shading/ lack.
inline constexpr float SurfaceMaterial::*kScalarLobes[] = {&SurfaceMaterial::anisotropy,
                                                           &SurfaceMaterial::iridescence};
/// Members by whose difference the light of two surfaces differs: shares of lobes, and indices.
inline constexpr float SurfaceMaterial::*kShares[] = {
    &SurfaceMaterial::metallic, &SurfaceMaterial::specular,   &SurfaceMaterial::transmission,
    &SurfaceMaterial::ior,      &SurfaceMaterial::dispersion, &SurfaceMaterial::diffuse_transmission};

struct BsdfValue {
  Color value{0.0f, 0.0f, 0.0f};  ///< f * |cos|, without delta lobes
  float pdf = 0.0f;               ///< with which sample() chooses wi, per solid angle, without delta lobes
};

struct BsdfSample {
  Vec3 wi = Vec3::Zero();
  Color weight{0.0f, 0.0f, 0.0f};  ///< f * |cos| / pdf of all lobes together; zero ends the path
  float pdf = 0.0f;                ///< per solid angle; for a delta lobe the lobe's probability
  bool delta = false;
  bool transmitted = false;
  /// (n_o / n_i)^2 if the sample refracts, otherwise 1. The weight contains it. Russian roulette should
  /// divide it out, because it is undone when the path leaves the medium.
  float radiance_scale = 1.0f;
  float spread = 1.0f;  ///< angular width of the chosen lobe, 0 mirror to 1 diffuse; widens ray cones
};

class Bsdf {
 public:
  /// `ng` is the geometric normal on the side of wo. `ns` is the shading normal, with dot(ns, ng) > 0; the
  /// constructor bends it towards ng until the mirror direction of wo is above the surface. `nc` is the
  /// shading normal of the clearcoat. `front` says that wo is on the front side of the triangle, which is
  /// outside the medium.
  Bsdf(const SurfaceMaterial& material, const Vec3& ng, const Vec3& ns, const Vec3& nc, const Vec3& wo,
       bool front);

  BsdfValue evaluate(const Vec3& wi) const;
  /// `u_lobe` chooses the lobe, `u` the direction. All numbers are in [0, 1).
  BsdfSample sample(float u_lobe, const Vec2& u) const;

  /// The directional albedo for wo, in [0, 1]: the power that a white furnace sends back, within the accuracy
  /// of the tables. It contains reflection and transmission, without the radiance scale of refraction.
  const Color& albedo() const { return albedo_; }
  /// Whether light can arrive from behind the surface.
  bool transmits() const { return glass_ != Glass::none || lets_through_; }
  /// The fraction of light that passes unrefracted, from -wo to wo: the delta transmission of a smooth
  /// thin-walled surface. Zero for all others. It equals sample() on average.
  Color unrefracted_transmittance() const;
  /// Whether all lobes are deltas, so that next-event estimation is useless.
  bool is_delta() const { return is_delta_; }

  /// Whether some lobe is narrower than this perceptual roughness. Deltas always are, so 0 means only deltas.
  /// Microfacets and clearcoat are if their roughness is smaller.
  bool has_narrow(float roughness) const { return has(roughness, true); }
  /// Whether some lobe is not narrower.
  bool has_wide(float roughness) const { return has(roughness, false); }
  /// Two surfaces with the wide and with the narrow lobes. Their values and albedos add up to those of this
  /// surface. Each lobe keeps its value, between the same layers. Each part samples only its own lobes, and
  /// transmits only if one of them does. A part without lobes is black.
  Bsdf wide_part(float roughness) const { return part(roughness, false); }
  Bsdf narrow_part(float roughness) const { return part(roughness, true); }

 private:
  enum class Glass : std::uint8_t {
    none,
    thin,        ///< a sheet: the reflection lobe mirrored to the other side
    refracting,  ///< the boundary of a medium
    clear,       ///< the boundary of a medium with the outside's index: light passes unrefracted
  };
  /// Reflectance and transmittance of a microfacet of glass, with tint and weight. The reflection of thin
  /// glass is in the lobe of the opaque part.
  struct Facet {
    float schlick = 0.0f;  ///< weight between f0 and f90
    Color reflected = Color::Zero();
    Color transmitted = Color::Zero();
    float cos_t = 0.0f;                ///< cosine of the refracted ray
    float probability_reflect = 1.0f;  ///< of choosing reflection
  };

  struct Base;
  void set_up_base(const SurfaceMaterial& material, bool front);
  void choose_glass(const Base& base, bool thin_walled, bool front);
  void set_up_facets(Base& base, const SurfaceMaterial& material);
  void set_up_reflection(Base& base, const SurfaceMaterial& material);
  void set_up_diffuse(const Base& base, const SurfaceMaterial& material);
  void set_up_glass(const Base& base);
  void set_up_refraction(float roughness, float ior_f0);
  void set_up_layers(const SurfaceMaterial& material);
  /// Scales the probabilities of the lobes to the sum one, and sets is_delta_.
  void normalize_chances();

  bool has(float roughness, bool narrow) const;
  Bsdf part(float roughness, bool narrow) const;
  /// The part of albedo_ of each kind of lobe. Microfacets have the rest.
  Color diffuse_albedo() const;
  Color sheen_albedo() const;

  /// Albedos of the microfacets for a direction of this cosine.
  GgxAlbedo facets_albedo(const Vec3& w, float cosine) const {
    return anisotropic_ ? anisotropic_->albedo(w, cosine) : row_.at(cosine);
  }
  const GgxAlbedo& mean_albedo() const { return anisotropic_ ? anisotropic_->row.mean : row_.mean(); }
  GgxLobe::Terms facets_terms(const Vec3& h, float h2, const Vec3& wi, float cos_i) const {
    return anisotropic_ ? anisotropic_->terms(h, h2, ggx_.cos_o, ggx_.root_o, wi, cos_i)
                        : ggx_.terms(ns_, h, h2, cos_i);
  }

  /// The power that the dielectric layer transmits.
  float passed(const GgxAlbedo& albedo) const {
    return std::max(0.0f, coupling_[0] + coupling_[1] * albedo.loss + coupling_[2] * albedo.b +
                              coupling_[3] * albedo.b_scaled);
  }
  /// The same for a direction of this cosine, with the change by a film.
  float passed(const GgxAlbedo& albedo, float cosine) const {
    return film_ ? film_passed(albedo, cosine) : passed(albedo);
  }
  float film_passed(const GgxAlbedo& albedo, float cosine) const;
  /// The change by a film of the reflectance of the dielectric.
  Color film_on_dielectric(float cosine) const {
    return film_->film.change(cosine, film_->dielectric_f0, film_->dielectric_f90);
  }
  /// The same for the mix of metal and dielectric.
  Color film_change(float cosine) const;
  Facet facet(float cos_h) const;
  void add_reflection(const Vec3& wi, float cos_i, BsdfValue& result) const;
  void add_transmission(const Vec3& wi, float cos_i, BsdfValue& result) const;
  void add_layers(const Vec3& wi, BsdfValue& result) const;

  BsdfSample sample_microfacet(float u_lobe, const Vec2& u) const;
  BsdfSample sample_delta(bool transmitted, const Facet& facet) const;
  /// Completes a sample of a lobe around `normal` with the value and pdf of all lobes.
  BsdfSample finish(const Vec3& wi, const Vec3& normal, float spread) const;

  Vec3 wo_, ng_, ns_;

  // Microfacets of metal, opaque dielectric and thin glass: weighted sums of Schlick's f0 and f90. The
  // `multiple` ones are for light that meets more than one microfacet. It has the same lobe, times the excess
  // of the scales over one.
  GgxLobe ggx_;
  GgxTables::Row row_;
  std::optional<AnisotropicLobe> anisotropic_;  ///< in place of the distribution of ggx_ and of row_
  float scale_o_ = 1.0f;
  Color f0_, multiple_f0_, multiple_f90_;
  float f90_ = 0.0f;

  // The diffuse base under the dielectric, on both sides, and the coefficients of passed(): 1 - the layer's
  // albedo for wi is [0] + [1] loss + [2] b + [3] b_scaled.
  Color diffuse_, diffuse_through_;
  float coupling_[4];

  Glass glass_ = Glass::none;
  float transmit_scale_ = 1.0f;  ///< BsdfSample::radiance_scale of transmitted light
  bool lets_through_ = false;    ///< has a diffuse base on the other side
  bool is_delta_ = false;
  bool has_layers_ = false;

  struct FilmOnBase {
    ThinFilm film;
    Color metal_f0, dielectric_f0;
    float dielectric_f90, metallic, dielectric;  ///< the last two are shares in the reflection lobe
  };
  std::optional<FilmOnBase> film_;
  float mean_passed_ = 1.0f;  ///< passed(), over the hemisphere

  // Set only for glass.
  Color glass_f0_, glass_tint_;
  float glass_f90_, glass_weight_, eta_, fresnel_base_;
  // Set only for rough refracting glass: factors of the light that is scattered more than once, to each side.
  // They are multiplied by the loss for wi.
  float glass_multiple_reflect_;
  Color glass_multiple_transmit_;
  GlassTables::Rows glass_here_, glass_there_;
  LossLobe loss_lobe_;

  // Set only for surfaces with layers, except base_scale_.
  float base_scale_ = 1.0f;  ///< the part of light that clearcoat and sheen transmit to the lobes below them
  Vec3 nc_;
  GgxLobe coat_;
  float coat_weight_, coat_albedo_;
  Color sheen_color_;
  SheenLobe sheen_;

  Color albedo_;
  // The probabilities of the lobes. Their sum is one, or zero for a black surface.
  float p_microfacet_ = 0.0f;
  float p_diffuse_ = 0.0f;
  float p_diffuse_through_ = 0.0f;
  float p_clear_ = 0.0f;
  float p_loss_reflect_ = 0.0f;
  float p_loss_transmit_ = 0.0f;
  float p_coat_ = 0.0f;
  float p_sheen_ = 0.0f;
};

}  // namespace gatelight::renderer
