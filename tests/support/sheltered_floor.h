#pragma once
// A floor in a box of black walls that objects, lamps and rays may ignore, in a sky of radiance 1.

#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"

namespace gatelight::testing {

constexpr scene::RayKinds all_but(scene::RayKinds kinds) {
  return static_cast<scene::RayKinds>(scene::kAllRays & ~kinds);
}

/// Instance 0 is the walls; they look inwards. The camera looks down from the height 2 at the origin.
struct ShelteredFloor : SceneBuilder {
  static constexpr float kAlbedo = 0.6f;

  renderer::RenderOptions options;

  ShelteredFloor() {
    box(material(lambert(Color::Zero())), Vec3(-5, -5, -5), Vec3(5, 5, 5), true);
    scene().instances[0].name = "walls";
    options.width = options.height = 12;
    options.spp = 64;
    options.environment.constant = Color::Ones();
    options.camera.look_at = renderer::LookAt{Vec3(0, 2, 0), Vec3::Zero(), Vec3(0, 0, -1)};
    options.camera.fov_degrees = 0.5f;
  }
  explicit ShelteredFloor(const scene::Material& floor) : ShelteredFloor() { add_floor(*this, floor, 3); }

  static scene::Material matte() { return lambert(Color::Constant(kAlbedo)); }

  scene::Instance& walls() { return scene().instances[0]; }
  void hide_walls(scene::RayKinds from) { walls().visibility.rays &= all_but(from); }
  renderer::Picture picture() { return renderer::Renderer(scene(), options).render(); }
  Moments seen() { return channel_moments(picture(), 1); }
};

}  // namespace gatelight::testing
