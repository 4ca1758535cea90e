#pragma once
// The glTF metallic-roughness surface with its extensions, at one point and for one outgoing direction.
//
// Conventions, for all functions: directions are unit, in world space, and point away from the surface. The
// geometric normal `ng` lies on the side of `wo`. Values include the cosine: evaluate() returns f * |cos(ns,
// wi)|, and a sample's weight is f * |cos| / pdf. Densities are per solid angle. Delta lobes are zero in
// evaluate(). Light is reflected only where wi is on the side of ng, and transmitted only where it is not,
// whatever the shading normal says: normal maps never leak light.

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
  float spread = 1.0f;  ///< angular width of the lobe that was chosen: 0 mirror, 1 diffuse; widens ray cones
};

class Bsdf {
 public:
  /// Below this perceptual roughness a specular lobe is a delta.
  static constexpr float kDeltaRoughness = 0.01f;

  /// ng: geometric normal on the side of wo. ns: shading normal, dot(ns, ng) > 0 (it is bent towards ng where
  /// wo would be below its horizon). nc: shading normal of the clearcoat. front: wo is on the front of the
  /// triangle (light enters the medium when it is transmitted from there).
  Bsdf(const SurfaceMaterial& material, const Vec3& ng, const Vec3& ns, const Vec3& nc, const Vec3& wo,
       bool front);

  BsdfValue evaluate(const Vec3& wi) const;
  /// u_lobe chooses the lobe, u the direction; all in [0, 1).
  BsdfSample sample(float u_lobe, const Vec2& u) const;

  /// Directional albedo for wo: what a white furnace would show, within the accuracy of the tables.
  /// Reflection and transmission together; in [0, 1].
  Color albedo() const;
  /// Whether light can come from behind the surface.
  bool transmits() const;
  /// Fraction of light that goes straight through, from -wo to wo, without being bent or blurred: the delta
  /// transmission of a smooth thin-walled surface. Zero for all others. Agrees with sample() in the mean.
  Color straight_transmittance() const;
  /// All lobes are deltas: next-event estimation is of no use.
  bool is_delta() const;
};

}  // namespace gatelight::renderer
