#pragma once
// Decides whether a surface stops a ray: alpha masks, stochastic alpha, and panes of clear glass for shadow
// rays.

#include <cstdint>
#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "renderer/surface/media.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// The passage of a shadow ray through a surface.
struct Passage {
  Color transmittance{0.0f, 0.0f, 0.0f};  ///< zero: blocked
  /// Absorption per metre of the medium that begins at the surface; negative where it ends. Zero for a volume
  /// of Media.
  Color absorption{0.0f, 0.0f, 0.0f};
  bool front = true;  ///< the ray meets the front
};

/// Turns glass with an inside into the surface for unrefracted light: a smooth bare sheet.
void remove_refraction(SurfaceMaterial& material);

/// Thread-safe after construction; holds references to its arguments.
class Coverage {
 public:
  /// `unrefracted_glass`: GlassShadows::straight.
  Coverage(const scene::Scene& scene, const Textures& textures, const Media& media,
           bool unrefracted_glass = false);

  const Media& media() const { return media_; }
  /// The number of an instance's material.
  int material_of(std::uint32_t instance) const {
    return scene_.mesh_of(scene_.instances[instance]).material;
  }

  /// Whether rays may pass through this instance because it has an alpha test.
  bool tests_alpha(std::uint32_t instance) const { return flags_[instance] & kAlpha; }
  /// Whether rays pass the back faces of this instance.
  bool culls_backs(std::uint32_t instance) const { return flags_[instance] & kCulled; }
  /// Whether shadow rays may pass through this instance: it has an alpha test, is a pane, is culled, or
  /// is glass that shadow rays pass.
  bool filters_shadows(std::uint32_t instance) const { return flags_[instance] != 0; }

  /// False where a ray with this seed passes through the surface. A blended surface decides by
  /// alpha_number() of the seed, the instance and the primitive. So surfaces are independent of each other
  /// and of the order in which they are hit.
  bool is_there(const Hit& hit, std::uint32_t seed) const;
  /// The alpha of a surface with this material.
  float alpha(const Hit& hit, const scene::Material& material) const;

  /// Whether rays between rough surfaces and lights pass glass with an inside unrefracted; whether this
  /// instance is such glass.
  bool unrefracted_glass() const { return unrefracted_glass_; }
  bool is_unrefracted_glass(std::uint32_t instance) const { return flags_[instance] & kUnrefractedGlass; }

  /// Whether the transmittance for a shadow ray depends on the glass that the ray met before.
  bool orders(std::uint32_t instance) const { return !media_.empty() && is_unrefracted_glass(instance); }

  /// The passage of a shadow ray through the surface. Smooth thin-walled transmission and unrefracted glass
  /// let light pass; every other surface blocks it. `around`: the volumes that the ray is in.
  Passage pass(const Hit& hit, const Vec3& direction, const MediumStack& around = {}) const;

 private:
  static constexpr std::uint8_t kAlpha = 1;
  static constexpr std::uint8_t kPane = 2;
  static constexpr std::uint8_t kUnrefractedGlass = 4;
  static constexpr std::uint8_t kCulled = 8;

  const scene::Scene& scene_;
  const Textures& textures_;
  const Media& media_;
  bool unrefracted_glass_;
  std::vector<std::uint8_t> flags_;  ///< by instance
};

}  // namespace gatelight::renderer
