#pragma once
// The room of tests/support/room.h with all kinds of rules about who sees and lights what.

#include <initializer_list>
#include <vector>

#include "tests/support/materials.h"
#include "tests/support/room.h"

namespace gatelight::testing {

/// The camera does not see the left wall; a box is a holdout; the lamp is hidden from the camera; a panel
/// lights all but the back wall, for diffuse rays only; a bulb lights the floor and the balls; in the light
/// of a sun only the gold ball casts a shadow; diffuse rays do not see the sky.
inline scene::Scene restricted_room() {
  SceneBuilder builder;
  builder.scene() = room();
  scene::Scene& scene = builder.scene();
  enum : std::size_t { kFloor, kBack, kLeft, kLamp, kGold, kGlass, kVeil, kBox, kPanel };
  builder.box(0, Vec3(-0.2f, 0, 0.6f), Vec3(0.2f, 0.3f, 1.0f));
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color(4, 2, 1))),
               Vec3(-1.9f, 0.5f, 0.5f), Vec3(0, 0, -1), Vec3(0, 1, 0));
  scene.materials.back().name = "panel";
  scene.materials[1].name = "lamp";
  scene::Material& veil = scene.materials[4];
  veil.transmission = veil.roughness = 0.4f;
  scene.lights = {point_light(Vec3(0.5f, 2, 1), Color(1, 2, 3)), sun(Vec3(-0.5f, -1, -0.7f), Color(2, 2, 1))};
  scene.lights[0].name = "bulb";
  scene.lights[1].name = "noon";

  const auto hide = [&](std::size_t i, scene::RayKinds from) {
    scene.instances[i].visibility.rays &= static_cast<scene::RayKinds>(~from);
  };
  hide(kLeft, scene::kCameraRays);
  hide(kBack, scene::kShadowRays);
  hide(kLamp, scene::kCameraRays);
  hide(kPanel, scene::kGlossyRays | scene::kTransmissionRays | scene::kVolumeRays);
  scene.instances[kBox].visibility.holdout = true;
  scene.environment_rays &= static_cast<scene::RayKinds>(~scene::kDiffuseRays);
  const auto set = [&](std::initializer_list<std::size_t> members, bool inside = true) {
    scene::ObjectSet made{std::vector<std::uint8_t>(scene.instances.size(), inside ? 0 : 1), !inside};
    for (const std::size_t member : members) made.instances[member] = inside ? 1 : 0;
    scene.object_sets.push_back(made);
    return static_cast<int>(scene.object_sets.size()) - 1;
  };
  scene.instances[kPanel].link.receivers = set({kBack}, false);
  scene.lights[0].link.receivers = set({kFloor, kGold, kGlass});
  scene.lights[1].link.blockers = set({kGold});
  return scene;
}

}  // namespace gatelight::testing
