#pragma once
// A scene with lights of every kind, each with a name, for tests of groups of lights.

#include "renderer/settings/options.h"
#include "tests/support/scene_builder.h"

namespace gatelight::testing {

/// A varnished floor, a wall, a ball of glass and a pane, under the point light "bulb", the spot light
/// "torch", the sun "noon", the textured "panel" and the plain "glow".
inline scene::Scene lit_by_all() {
  SceneBuilder builder;
  scene::Material varnish = SceneBuilder::lambert(Color(0.6f, 0.5f, 0.4f));
  varnish.clearcoat = 1.0f;
  varnish.clearcoat_roughness = 0.2f;
  builder.quad(builder.material(varnish), Vec3(-3, 0, 3), Vec3(6, 0, 0), Vec3(0, 0, -6));
  const int white = builder.material(SceneBuilder::lambert(Color(0.7f, 0.7f, 0.8f)));
  builder.quad(white, Vec3(-3, 0, -2), Vec3(6, 0, 0), Vec3(0, 3, 0));
  scene::Material glass;
  glass.metallic = glass.roughness = 0.0f;
  glass.transmission = glass.thickness = 1.0f;
  builder.sphere(builder.material(glass), Vec3(0.8f, 0.6f, 0.5f), 0.5f, 24, true);
  builder.quad(builder.material(SceneBuilder::clear_glass()), Vec3(-1.6f, 0, 0.8f), Vec3(1, 0, 0),
               Vec3(0, 1.2f, 0));

  scene::Material panel = SceneBuilder::lambert(Color::Zero(), Color(6, 5, 3));
  panel.name = "panel";
  panel.emission_texture.texture = 0;
  scene::Mesh& lamp =
      builder.quad(builder.material(panel), Vec3(-2, 1.5f, -1.9f), Vec3(1, 0, 0), Vec3(0, 1, 0));
  lamp.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  scene::Material glow = SceneBuilder::lambert(Color::Constant(0.3f), Color(3, 4, 5));
  glow.name = "glow";
  builder.box(builder.material(glow), Vec3(1.6f, 0, -0.6f), Vec3(1.9f, 0.4f, -0.3f));

  scene::Scene& scene = builder.scene();
  scene.images.push_back({.name = "made",
                          .width = 2,
                          .height = 2,
                          .channels = 3,
                          .pixels = {255, 255, 255, 40, 90, 200, 0, 0, 0, 250, 120, 60}});
  scene.textures.push_back({.image = 0});
  scene.lights.push_back({.name = "bulb", .intensity = Color(2, 1, 1), .position = Vec3(-0.5f, 2, 0.5f)});
  scene.lights.push_back({.name = "torch",
                          .type = scene::LightType::spot,
                          .intensity = Color(4, 6, 9),
                          .position = Vec3(1, 2.5f, 1),
                          .direction = Vec3(0, -1, -0.4f).normalized(),
                          .cos_inner = 0.95f});
  scene.lights.push_back({.name = "noon",
                          .type = scene::LightType::directional,
                          .intensity = Color(0.8f, 0.8f, 0.6f),
                          .direction = Vec3(0.4f, -1.0f, -0.3f).normalized()});
  return scene;
}

/// A group for each of its lights but "glow", and for the environment.
inline std::vector<renderer::LightGroup> groups_of_all() {
  return {{"bulb", {"bulb"}},
          {"torch", {"tor*"}},
          {"noon", {"noon"}},
          {"panel", {"panel"}},
          {"sky", {"environment"}}};
}

inline renderer::RenderOptions view_of_all() {
  renderer::RenderOptions options;
  options.width = 48;
  options.height = 32;
  options.spp = 8;
  options.threads = 2;
  options.camera.look_at = renderer::LookAt{{0.3f, 1.6f, 4.5f}, {0, 0.9f, 0}, {0, 1, 0}};
  options.light_groups = groups_of_all();
  return options;
}

}  // namespace gatelight::testing
