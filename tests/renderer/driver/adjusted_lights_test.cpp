// Pictures of scenes whose lights are adjusted.

#include <gtest/gtest.h>

#include "renderer/render.h"
#include "scene/light_adjustments.h"
#include "tests/support/room.h"

namespace gatelight::renderer {

namespace {

/// The room with a lamp's material named "lamp" and a point light named "bulb".
scene::Scene lit_room() {
  scene::Scene room = testing::room();
  room.materials[1].name = "lamp";
  room.lights.push_back({.name = "bulb", .intensity = Color(1.0f, 2.0f, 3.0f), .position = Vec3(-1, 2, 1)});
  return room;
}

std::vector<float> adjusted_picture(const std::vector<scene::LightAdjustment>& adjustments) {
  scene::Scene room = lit_room();
  scene::adjust_lights(room, adjustments);
  RenderOptions options = testing::small_picture();
  options.environment = {};
  options.aovs = {};
  return Renderer(room, options).render().layers[0].values;
}

TEST(AdjustedLights, TwiceTheLightIsExactlyTwiceTheRadiance) {
  const std::vector<float> once = adjusted_picture({}),
                           twice = adjusted_picture({{"*", Color::Constant(2.0f)}});
  ASSERT_EQ(once.size(), twice.size());
  float brightest = 0.0f;
  for (std::size_t i = 0; i < once.size(); ++i) {
    ASSERT_EQ(2.0f * once[i], twice[i]) << i;
    brightest = std::max(brightest, once[i]);
  }
  EXPECT_GT(brightest, 1.0f);
}

TEST(AdjustedLights, OffIsBlack) {
  for (const float value : adjusted_picture({{"*", Color::Zero()}})) ASSERT_EQ(value, 0.0f);
  const std::vector<float> bulb = adjusted_picture({{"*", Color::Zero()}, {"bulb", Color::Ones()}});
  EXPECT_GT(*std::max_element(bulb.begin(), bulb.end()), 0.01f);
}

}  // namespace
}  // namespace gatelight::renderer
