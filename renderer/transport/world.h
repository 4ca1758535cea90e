#pragma once
// A scene prepared for rendering. It does not change.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/light/environment.h"
#include "renderer/light/light_groups.h"
#include "renderer/light/light_rules.h"
#include "renderer/light/lights.h"
#include "renderer/shading/light_arrays.h"
#include "renderer/shading/shading.h"
#include "renderer/surface/accel.h"
#include "renderer/surface/coverage.h"
#include "renderer/surface/media.h"
#include "renderer/surface/ray_masks.h"
#include "renderer/surface/surface.h"
#include "renderer/surface/texture.h"
#include "scene/requirements.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct WorldOptions {
  EnvironmentOptions environment;
  LightSelection light_selection = LightSelection::tree;
  AccelOptions acceleration;
  GlassShadows glass_shadows = GlassShadows::refract;
  std::vector<LightGroup> light_groups;
  BackgroundOptions background;

  bool operator==(const WorldOptions&) const = default;
};

/// The parts that a world of another time takes over, if the scene's motion leaves them as they are.
struct ReusableParts {
  std::shared_ptr<const Textures> textures;
  std::shared_ptr<const Environment> environment;
  std::shared_ptr<Accel> accel;
};

/// Later members refer to earlier ones, so a world cannot be moved.
struct World {
  /// Works in the caller's arena. The scene must outlive the world. `earlier`: of a world with the same
  /// options and the same scene at another time, which must not be used any more. Throws the exceptions of
  /// the members, and BadOption for a shadow catcher that the scene does not have or without a separate
  /// background.
  explicit World(const scene::Scene& scene_in, const WorldOptions& options = {},
                 const ReusableParts& earlier = {});
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const scene::Scene& scene;
  scene::SceneRequirements requirements;
  ReusableParts lasting;
  const Textures& textures;
  Media media;
  const Environment& environment;
  Coverage coverage;
  Surfaces surfaces;
  /// 1 for shadow catchers, which are not visible themselves; empty without any.
  std::vector<std::uint8_t> catchers;
  RayMasks masks;
  const Accel& accel;
  Lights lights;
  LightRules light_rules;
  LightArrays light_arrays;
  const ShadingKernels& kernels;
  LightGroups light_groups;  ///< empty unless the parts of a picture are requested
  bool any_holdout;
  bool separate_background;  ///< the environment lights the scene, but is invisible to the camera
  std::string warning;       ///< about catchers that are not caught; else empty
  /// Whether all pictures are black: no light, and no surface that shows its own colour (unlit).
  bool is_dark() const;
  bool catches(std::uint32_t instance) const { return !catchers.empty() && catchers[instance] != 0; }
  bool holds_out(std::uint32_t instance) const {
    return any_holdout && scene.instances[instance].visibility.holdout;
  }
};

}  // namespace gatelight::renderer
