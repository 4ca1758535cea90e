#pragma once
// Decides whether a surface stops a ray: alpha masks, stochastic alpha, and panes of clear glass for shadow
// rays.

#include <cstdint>
#include <vector>

#include "renderer/surface/ray.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// Thread-safe after construction; holds references to its arguments.
class Coverage {
 public:
  Coverage(const scene::Scene& scene, const Textures& textures);

  /// Whether rays may pass through this instance because it has an alpha test.
  bool tests_alpha(std::uint32_t instance) const { return flags_[instance] & kAlpha; }
  /// Whether shadow rays may pass through this instance: it has an alpha test or is a pane.
  bool filters_shadows(std::uint32_t instance) const { return flags_[instance] != 0; }

  /// False where a ray with this seed passes through the surface. A blended surface decides by a hash of the
  /// seed, the instance and the primitive. So surfaces are independent of each other and of the order in
  /// which they are hit.
  bool is_there(const Hit& hit, std::uint32_t seed) const;

  /// The fraction of light that a shadow ray keeps behind the surface. Only smooth thin-walled transmission
  /// lets light go straight on; the fraction is zero for every other surface.
  Color pane_transmittance(const Hit& hit, const Vec3& direction) const;

 private:
  static constexpr std::uint8_t kAlpha = 1;
  static constexpr std::uint8_t kPane = 2;

  float alpha(const Hit& hit) const;

  const scene::Scene& scene_;
  const Textures& textures_;
  std::vector<std::uint8_t> flags_;  ///< by instance
};

}  // namespace gatelight::renderer
