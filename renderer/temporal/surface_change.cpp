#include "renderer/temporal/surface_change.h"

#include <algorithm>
#include <cmath>

#include "renderer/surface/media.h"

namespace gatelight::renderer {
namespace {

/// Dielectrics reflect as much beside their colour, and differences of darker colours are seen less.
constexpr float kDarkestColor = 0.04f;
/// Smoother lobes look alike.
constexpr float kSmoothest = 0.1f;

float relative(float a, float b, float least) {
  return std::abs(a - b) / std::max({a, b, least});
}
float relative(const Color& a, const Color& b, float least) {
  return (a - b).abs().maxCoeff() / std::max({a.maxCoeff(), b.maxCoeff(), least});
}

/// Of a lobe with a share of the light in both.
float lobe_change(float share_now, float share_earlier, float roughness_now, float roughness_earlier) {
  return std::abs(share_now - share_earlier) +
         std::max(share_now, share_earlier) * relative(roughness_now, roughness_earlier, kSmoothest);
}

float colors_change(const SurfaceMaterial& a, const SurfaceMaterial& b) {
  const Color through = a.diffuse_transmission * a.diffuse_transmission_color;
  const Color through_before = b.diffuse_transmission * b.diffuse_transmission_color;
  return relative(a.base_color, b.base_color, kDarkestColor) +
         relative(a.specular_color, b.specular_color, kDarkestColor) +
         (through - through_before).abs().maxCoeff() + (a.sheen_color - b.sheen_color).abs().maxCoeff();
}

float factors_change(const SurfaceMaterial& a, const SurfaceMaterial& b) {
  const float film = std::max(a.iridescence, b.iridescence);
  float shares = 0.0f;
  for (float SurfaceMaterial::*const share : kShares) shares += std::abs(a.*share - b.*share);
  return shares + lobe_change(gloss_of(a).share, gloss_of(b).share, a.roughness, b.roughness) +
         lobe_change(a.clearcoat, b.clearcoat, a.clearcoat_roughness, b.clearcoat_roughness) +
         a.sheen_color.maxCoeff() * relative(a.sheen_roughness, b.sheen_roughness, kSmoothest) +
         std::abs(a.iridescence - b.iridescence) +
         film * (std::abs(a.film_ior - b.film_ior) + relative(a.film_thickness, b.film_thickness, 100.0f)) +
         (a.anisotropy * a.anisotropy_direction - b.anisotropy * b.anisotropy_direction).norm();
}

/// Turned normals turn the reflection by twice as much.
float normals_change(const Surface& now, const Surface& earlier) {
  const Gloss gloss = gloss_of(now.material);
  return (now.shading_normal - earlier.shading_normal).norm() * (1.0f + 2.0f * gloss.share / gloss.lobe) +
         now.material.clearcoat * (now.coat_normal - earlier.coat_normal).norm();
}

}  // namespace

Gloss gloss_of(const SurfaceMaterial& m) {
  constexpr float kSmooth = 0.4f, kOfLobe = 0.7f;
  const bool coated = m.clearcoat > 0.1f;
  const float roughness = coated ? std::min(m.roughness, m.clearcoat_roughness) : m.roughness;
  const float dielectric = coated || roughness < kSmooth ? 1.0f : 0.0f;
  return {std::max({m.metallic, m.transmission, dielectric}),
          std::max(kOfLobe * roughness * roughness, 0.01f)};
}

float surface_change(const Surface& now, const Surface& earlier) {
  constexpr float kNoEmission = 1e-30f;
  if (now.unlit != earlier.unlit || now.material.thin_walled != earlier.material.thin_walled) return 1.0f;
  const float emission = relative(now.emission, earlier.emission, kNoEmission);
  if (now.unlit) return std::min(emission, 1.0f);
  return std::min(emission + colors_change(now.material, earlier.material) +
                      factors_change(now.material, earlier.material) + normals_change(now, earlier),
                  1.0f);
}

Color light_through(const scene::Material& m) {
  return m.has_volume() ? Color((-extinction_of(m) * m.thickness).exp()) : Color(Color::Ones());
}

float inside_change(const scene::Material& now, const scene::Material& earlier) {
  return now.transmission * (light_through(now) - light_through(earlier)).abs().maxCoeff();
}

}  // namespace gatelight::renderer
