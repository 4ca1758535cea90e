#pragma once
// A small room with something of everything, for tests of whole pictures.

#include "renderer/settings/options.h"
#include "tests/support/scene_builder.h"

namespace gatelight::testing {

/// A room with a lamp, a glossy and a glass ball, a sky through a hole and an alpha-blended veil.
inline scene::Scene room() {
  SceneBuilder builder;
  const int white = builder.material(SceneBuilder::lambert(Color(0.8f, 0.7f, 0.6f)));
  const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(10.0f)));
  scene::Material gold;
  gold.base_color = Color(1.0f, 0.7f, 0.3f);
  gold.roughness = 0.3f;
  scene::Material glass;
  glass.metallic = 0.0f;
  glass.roughness = 0.0f;
  glass.transmission = 1.0f;
  glass.thickness = 1.0f;
  scene::Material veil = SceneBuilder::lambert(Color(0.2f, 0.3f, 0.9f));
  veil.alpha_mode = scene::AlphaMode::blend;
  veil.base_alpha = 0.4f;
  builder.quad(white, Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  builder.quad(white, Vec3(-2, 0, -2), Vec3(4, 0, 0), Vec3(0, 3, 0));
  builder.quad(white, Vec3(-2, 0, 2), Vec3(0, 0, -4), Vec3(0, 3, 0));
  builder.quad(lamp, Vec3(-0.5f, 2.8f, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1));
  builder.sphere(builder.material(gold), Vec3(-0.7f, 0.5f, -0.5f), 0.5f, 32, true);
  builder.sphere(builder.material(glass), Vec3(0.7f, 0.5f, 0.2f), 0.5f, 32, true);
  builder.quad(builder.material(veil), Vec3(0.2f, 0, -1), Vec3(1, 0, 0), Vec3(0, 1.5f, 0));
  return builder.scene();
}

inline renderer::RenderOptions small_picture() {
  using renderer::Aov;
  renderer::RenderOptions options;
  options.width = 50;
  options.height = 40;
  options.spp = 6;
  options.camera.look_at = renderer::LookAt{{0.5f, 1.5f, 5.0f}, {0, 1, 0}, {0, 1, 0}};
  options.environment.constant = Color(0.3f, 0.4f, 0.6f);
  options.aovs = {Aov::albedo, Aov::normal, Aov::depth, Aov::instance_id, Aov::variance};
  return options;
}

}  // namespace gatelight::testing
