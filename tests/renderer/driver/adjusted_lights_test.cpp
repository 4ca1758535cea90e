// Pictures of scenes whose lights are adjusted, and the fingerprints of such scenes.

#include <gtest/gtest.h>

#include "renderer/fingerprint/scene_fingerprint.h"
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

TEST(AdjustedLights, AColourMultipliesItsChannels) {
  const std::vector<float> white = adjusted_picture({}),
                           red = adjusted_picture({{"*", Color(1.0f, 0.0f, 0.0f)}});
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < white.size(); i += 3) {
    before += static_cast<double>(white[i]);
    after += static_cast<double>(red[i]);
    ASSERT_EQ(red[i + 1], 0.0f);
    ASSERT_EQ(red[i + 2], 0.0f);
  }
  EXPECT_NEAR(after, before, 0.2 * before);  // lights are chosen by their luminance, so the noise differs
}

TEST(AdjustedLights, ChangeTheFingerprint) {
  const SceneFingerprint before = compute_scene_fingerprint(lit_room(), {});
  const auto changed = [&](const char* name, const char* part) {
    scene::Scene room = lit_room();
    scene::adjust_lights(room, {{name, Color(1.0f, 1.0f, 2.0f)}});
    const SceneFingerprint after = compute_scene_fingerprint(room, {});
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_EQ(before[i] != after[i], before[i].name == part) << name;
  };
  changed("lamp", "materials");
  changed("bulb", "lights");
}

}  // namespace
}  // namespace gatelight::renderer
