#pragma once
// A scene made ready for light, for tests of what lies below Renderer.

#include "renderer/transport/world.h"

namespace gatelight::testing {

/// The scene must outlive it.
struct BuiltWorld {
  explicit BuiltWorld(const scene::Scene& scene, const renderer::EnvironmentOptions& sky = {})
      : requirements(scene::compute_requirements(scene)),
        textures(scene),
        environment(sky),
        coverage(scene, textures),
        surfaces(scene, textures),
        accel(scene, coverage, {}),
        lights(scene, textures, environment, renderer::LightSelection::tree),
        world{scene, requirements, textures, surfaces, accel, environment, lights} {}

  scene::SceneRequirements requirements;
  renderer::Textures textures;
  renderer::Environment environment;
  renderer::Coverage coverage;
  renderer::Surfaces surfaces;
  renderer::Accel accel;
  renderer::Lights lights;
  renderer::World world;
};

}  // namespace gatelight::testing
