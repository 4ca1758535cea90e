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

/// A shadow ray through a surface.
struct Passage {
  Color transmittance{0.0f, 0.0f, 0.0f};  ///< zero: blocked
  /// Per metre, of the medium that begins at the surface; negative where it ends. Of a volume of Media it is
  /// left out.
  Color absorption{0.0f, 0.0f, 0.0f};
  bool front = true;  ///< the ray meets the front
};

/// Makes of glass with an inside what light that is not bent meets: a smooth bare sheet.
void straighten(SurfaceMaterial& material);

/// Thread-safe after construction; holds references to its arguments.
class Coverage {
 public:
  /// `straight_glass`: GlassShadows::straight.
  Coverage(const scene::Scene& scene, const Textures& textures, const Media& media,
           bool straight_glass = false);

  const Media& media() const { return media_; }

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

  /// Whether rays between rough surfaces and lights pass glass with an inside unbent; whether this instance
  /// is such glass.
  bool straight_glass() const { return straight_glass_; }
  bool is_straight_glass(std::uint32_t instance) const { return flags_[instance] & kStraightGlass; }

  /// Whether what a shadow ray keeps depends on the glass that it met before.
  bool orders(std::uint32_t instance) const { return !media_.empty() && is_straight_glass(instance); }

  /// What a shadow ray keeps behind the surface. Smooth thin-walled transmission and straight glass let light
  /// go straight on; every other surface blocks it. `around`: the volumes that the ray is in.
  Passage pass(const Hit& hit, const Vec3& direction, const Interior& around = {}) const;

 private:
  static constexpr std::uint8_t kAlpha = 1;
  static constexpr std::uint8_t kPane = 2;
  static constexpr std::uint8_t kStraightGlass = 4;
  static constexpr std::uint8_t kCulled = 8;

  float alpha(const Hit& hit) const;

  const scene::Scene& scene_;
  const Textures& textures_;
  const Media& media_;
  bool straight_glass_;
  std::vector<std::uint8_t> flags_;  ///< by instance
};

}  // namespace gatelight::renderer
