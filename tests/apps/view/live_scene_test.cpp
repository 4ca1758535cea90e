#include "apps/view/live_scene.h"

#include <gtest/gtest.h>

#include "base/errors.h"

namespace gatelight::apps {
namespace {

const std::string kRoom = GATELIGHT_SOURCE_DIR "/data/moving-room.glb";

void expect_same(const scene::Scene& a, const scene::Scene& b) {
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (std::size_t i = 0; i < a.instances.size(); ++i)
    EXPECT_TRUE(a.instances[i].transform.matrix() == b.instances[i].transform.matrix()) << i;
  for (std::size_t i = 0; i < a.materials.size(); ++i)
    EXPECT_TRUE((a.materials[i].emission == b.materials[i].emission).all()) << a.materials[i].name;
  for (std::size_t i = 0; i < a.lights.size(); ++i)
    EXPECT_TRUE((a.lights[i].intensity == b.lights[i].intensity).all()) << a.lights[i].name;
  EXPECT_EQ(a.dark_lights, b.dark_lights);
}

scene::Scene loaded(double seconds, const std::vector<scene::LightAdjustment>& lights) {
  return scene::load_gltf(kRoom, {.time = seconds, .lights = lights});
}

TEST(LiveScene, IsTheSceneThatLoadingGives) {
  LiveScene live(kRoom, {.time = 0.4});
  ASSERT_FALSE(live.scene().materials.empty());
  const std::vector<scene::LightAdjustment> off = {{"*", Color::Zero()}},
                                            bright = {{"*", Color::Constant(3.0f)}};
  struct Step {
    double seconds;
    std::vector<scene::LightAdjustment> lights;
    bool changes;
  };
  for (const Step& step :
       {Step{0.4, {}, false}, Step{0.4, off, true}, Step{0.9, off, true}, Step{0.9, off, false},
        Step{0.9, bright, true}, Step{0.2, bright, true}, Step{0.2, {}, true}}) {
    EXPECT_EQ(live.show(step.seconds, step.lights), step.changes);
    expect_same(live.scene(), loaded(step.seconds, step.lights));
  }
}

TEST(LiveScene, TakesLightsThatAreOffAtThisTime) {
  LiveScene live(kRoom, {.time = 0.0});
  EXPECT_NO_THROW(live.show(1.5, {{"bulb", Color::Constant(2.0f)}}));
  expect_same(live.scene(), loaded(1.5, {}));
}

TEST(LiveScene, StaysAsItWasForUnknownLights) {
  LiveScene live(kRoom, {.time = 0.4, .lights = {{"*", Color::Constant(2.0f)}}});
  EXPECT_THROW(live.show(0.4, {{"no such lamp", Color::Zero()}}), InputError);
  expect_same(live.scene(), loaded(0.4, {{"*", Color::Constant(2.0f)}}));
}

}  // namespace
}  // namespace gatelight::apps
