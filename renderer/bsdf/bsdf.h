#pragma once
// The glTF metallic-roughness surface with its extensions, at one point and for one outgoing direction.
//
// Conventions, for all functions: directions are unit, in world space, and point away from the surface. The
// geometric normal `ng` lies on the side of `wo`. Values include the cosine: evaluate() returns f * |cos(ns,
// wi)|, and a sample's weight is f * |cos| / pdf. Densities are per solid angle. Delta lobes are zero in
// evaluate(). Light is reflected only where wi is on the side of ng, and transmitted only where it is not,
// whatever the shading normal says: normal maps never leak light.
//
// Values are of radiance, as camera paths carry it: light that is refracted from a medium of index n_i into
// wo's of index n_o is scaled by (n_o / n_i)^2, on top of the power that is transmitted. A path that enters
// and leaves has the scales 1 / eta^2 and eta^2. The equations and their sources are in README.md.

#include <cstdint>

#include "renderer/bsdf/ggx.h"
#include "renderer/bsdf/glass_tables.h"
#include "renderer/bsdf/sheen.h"
#include "renderer/bsdf/tables.h"
#include "scene/math.h"

namespace gatelight::renderer {

using scene::Color;
using scene::Vec2;
using scene::Vec3;

/// Everything the lobes need, textures and vertex colours applied.
struct SurfaceMaterial {
  Color base_color{1.0f, 1.0f, 1.0f};
  float metallic = 0.0f;
  float roughness = 1.0f;  ///< perceptual; GGX alpha is its square
  float ior = 1.5f;        ///< of the inside; 0 means Fresnel is 1 everywhere (KHR_materials_ior)
  float specular = 1.0f;
  Color specular_color{1.0f, 1.0f, 1.0f};
  float transmission = 0.0f;
  bool thin_walled = true;  ///< transmission does not refract: both sides of a sheet at once
  float clearcoat = 0.0f;
  float clearcoat_roughness = 0.0f;
  Color sheen_color{0.0f, 0.0f, 0.0f};
  float sheen_roughness = 0.0f;
};

struct BsdfValue {
  Color value{0.0f, 0.0f, 0.0f};  ///< f * |cos|, without delta lobes
  float pdf = 0.0f;               ///< of sample() choosing wi, per solid angle, without delta lobes
};

struct BsdfSample {
  Vec3 wi = Vec3::Zero();
  Color weight{0.0f, 0.0f,
               0.0f};  ///< f * |cos| / pdf over all lobes that could have made wi; zero: path ends
  float pdf = 0.0f;    ///< per solid angle; for a delta lobe the probability of the lobe
  bool delta = false;
  bool transmitted = false;
  /// (n_o / n_i)^2 where the sample refracts, else 1. It is in the weight; Russian roulette should take it
  /// out, as it comes back when the path leaves the medium.
  float radiance_scale = 1.0f;
  float spread = 1.0f;  ///< angular width of the lobe that was chosen: 0 mirror, 1 diffuse; widens ray cones
};

class Bsdf {
 public:
  /// Below this perceptual roughness a specular lobe is a delta.
  static constexpr float kDeltaRoughness = renderer::kDeltaRoughness;

  /// ng: geometric normal on the side of wo. ns: shading normal, dot(ns, ng) > 0 (it is bent towards ng where
  /// wo would be below its horizon). nc: shading normal of the clearcoat. front: wo is on the front of the
  /// triangle (light enters the medium when it is transmitted from there).
  Bsdf(const SurfaceMaterial& material, const Vec3& ng, const Vec3& ns, const Vec3& nc, const Vec3& wo,
       bool front);

  BsdfValue evaluate(const Vec3& wi) const;
  /// u_lobe chooses the lobe, u the direction; all in [0, 1).
  BsdfSample sample(float u_lobe, const Vec2& u) const;

  /// Directional albedo for wo: the power a white furnace would send back, within the accuracy of the tables.
  /// Reflection and transmission together, without the radiance scale of refraction; in [0, 1].
  const Color& albedo() const { return albedo_; }
  /// Whether light can come from behind the surface.
  bool transmits() const { return glass_ != Glass::none; }
  /// Fraction of light that goes straight through, from -wo to wo, without being bent or blurred: the delta
  /// transmission of a smooth thin-walled surface. Zero for all others. Agrees with sample() in the mean.
  Color straight_transmittance() const;
  /// All lobes are deltas: next-event estimation is of no use.
  bool is_delta() const { return is_delta_; }

  /// Whether some lobe is narrower than this perceptual roughness: a delta (whatever the number, so that 0
  /// means deltas alone), or microfacets or clearcoat below it.
  bool has_narrow(float roughness) const;
  /// Whether some lobe is not.
  bool has_wide(float roughness) const;
  /// The lobes that are not narrow, and those that are: two surfaces whose values and albedos add up to this
  /// one's. Each lobe is as it is here, between the same layers; each part samples its own lobes alone, and
  /// transmits only if one of them does. A part without lobes is black.
  Bsdf wide_part(float roughness) const { return part(roughness, false); }
  Bsdf narrow_part(float roughness) const { return part(roughness, true); }

 private:
  enum class Glass : std::uint8_t {
    none,
    thin,        ///< a sheet: reflection mirrored to the other side
    refracting,  ///< the boundary of a medium
    clear,       ///< the boundary of a medium like the outside: nothing but a straight passage
  };
  /// What a microfacet of glass reflects and transmits, tint and weight applied. Thin glass is reflected with
  /// the opaque rest.
  struct Facet {
    float schlick = 0.0f;  ///< weight between f0 and f90
    Color reflected = Color::Zero();
    Color transmitted = Color::Zero();
    float cos_t = 0.0f;                ///< of the refracted ray
    float probability_reflect = 1.0f;  ///< of choosing the reflection
  };

  void set_up_base(const SurfaceMaterial& material, bool front);
  void set_up_refraction(float roughness, float ior_f0);
  void set_up_layers(const SurfaceMaterial& material);
  /// Makes the chances of the lobes add up to one; knows then whether all are deltas.
  void normalize_chances();

  Bsdf part(float roughness, bool narrow) const;
  /// What each kind of lobe has of albedo_. Microfacets have what these leave.
  Color diffuse_albedo() const;
  Color sheen_albedo() const;

  /// Power that the dielectric layer lets through.
  float passed(const GgxAlbedo& albedo) const {
    return std::max(0.0f, coupling_[0] + coupling_[1] * albedo.loss + coupling_[2] * albedo.b +
                              coupling_[3] * albedo.b_scaled);
  }
  Facet facet(float cos_h) const;
  void add_reflection(const Vec3& wi, float cos_i, BsdfValue& result) const;
  void add_transmission(const Vec3& wi, float cos_i, BsdfValue& result) const;
  void add_layers(const Vec3& wi, BsdfValue& result) const;

  BsdfSample sample_microfacet(float u_lobe, const Vec2& u) const;
  BsdfSample sample_delta(bool transmitted, const Facet& facet) const;
  /// Completes a sample of a lobe around `normal` with the value and density of all lobes.
  BsdfSample finish(const Vec3& wi, const Vec3& normal, float spread) const;

  Vec3 wo_, ng_, ns_;

  // Microfacets of metal, opaque dielectric and thin glass: Schlick's f0 and f90, weighted and added up, for
  // the light that meets one microfacet, and for what meets more, which is scattered like the first (times
  // the excess of the scales over one).
  GgxLobe ggx_;
  GgxTables::Row row_;
  float scale_o_ = 1.0f;
  Color f0_, multiple_f0_, multiple_f90_;
  float f90_ = 0.0f;

  // Diffuse base under the dielectric, times 1 - its albedo for wi, which is [0] + [1] loss + [2] b + [3]
  // b_scaled.
  Color diffuse_;
  float coupling_[4];

  Glass glass_ = Glass::none;
  bool is_delta_ = false;
  bool has_layers_ = false;

  // Set only with glass.
  Color glass_f0_, glass_tint_;
  float glass_f90_, glass_weight_, eta_, fresnel_base_;
  // Set only with rough refracting glass: what it scatters more than once, to either side, times the loss
  // there.
  float glass_multiple_reflect_;
  Color glass_multiple_transmit_;
  GlassTables::Rows glass_here_, glass_there_;
  LossLobe loss_lobe_;

  // Set only with layers.
  float base_scale_ = 1.0f;  ///< what clearcoat and sheen let through to everything above
  Vec3 nc_;
  GgxLobe coat_;
  float coat_weight_, coat_albedo_;
  Color sheen_color_;
  SheenLobe sheen_;

  Color albedo_;
  // Of choosing a lobe; they add up to one, or are all zero for a black surface.
  float p_microfacet_ = 0.0f;
  float p_diffuse_ = 0.0f;
  float p_clear_ = 0.0f;
  float p_loss_reflect_ = 0.0f;
  float p_loss_transmit_ = 0.0f;
  float p_coat_ = 0.0f;
  float p_sheen_ = 0.0f;
};

}  // namespace gatelight::renderer
