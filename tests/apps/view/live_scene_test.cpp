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
  for (std::size_t i = 0; i < a.instances.size(); ++i) {
    EXPECT_EQ(a.instances[i].visibility, b.instances[i].visibility) << a.instances[i].name;
    EXPECT_EQ(a.instances[i].link, b.instances[i].link) << a.instances[i].name;
  }
  EXPECT_EQ(a.environment_rays, b.environment_rays);
  EXPECT_EQ(a.environment_link, b.environment_link);
  EXPECT_EQ(a.object_sets, b.object_sets);
}

scene::Scene loaded(double seconds, const SceneChanges& changes) {
  return scene::load_gltf(kRoom, {.time = seconds,
                                  .lights = changes.lights,
                                  .visibility = changes.visibility,
                                  .light_links = changes.light_links});
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
    EXPECT_EQ(live.show(step.seconds, {.lights = step.lights}), step.changes);
    expect_same(live.scene(), loaded(step.seconds, {.lights = step.lights}));
  }
}

TEST(LiveScene, ReplacesWhatRaysSeeAndWhomLightsConcern) {
  LiveScene live(kRoom, {.time = 0.4});
  const std::string some = live.scene().instances.at(0).name;
  const SceneChanges unseen{.visibility = {{.name = some, .off = scene::kCameraRays},
                                           {.name = "environment", .off = scene::kGlossyRays}}};
  const SceneChanges linked{
      .visibility = {{.name = "*", .off = scene::kVolumeRays}},
      .light_links = {{"*", false, true, {some}}, {"environment", true, false, {some}}}};
  for (const auto& [seconds, changes] : {std::pair(0.4, unseen), {0.4, linked}, {0.9, linked}, {0.9, {}}}) {
    EXPECT_TRUE(live.show(seconds, changes));
    EXPECT_FALSE(live.show(seconds, changes));
    expect_same(live.scene(), loaded(seconds, changes));
  }
  EXPECT_TRUE(live.show(0.9, linked));
  EXPECT_THROW(live.show(0.9, {.light_links = {{"no such lamp", false, false, {some}}}}), InputError);
  EXPECT_THROW(live.show(0.9, {.visibility = {{.name = "no such object", .holdout = true}}}), InputError);
  expect_same(live.scene(), loaded(0.9, linked));
}

TEST(LiveScene, TakesLightsThatAreOffAtThisTime) {
  LiveScene live(kRoom, {.time = 0.0});
  EXPECT_NO_THROW(live.show(1.5, {.lights = {{"bulb", Color::Constant(2.0f)}}}));
  expect_same(live.scene(), loaded(1.5, {}));
}

TEST(LiveScene, StaysAsItWasForUnknownLights) {
  LiveScene live(kRoom, {.time = 0.4, .lights = {{"*", Color::Constant(2.0f)}}});
  EXPECT_THROW(live.show(0.4, {.lights = {{"no such lamp", Color::Zero()}}}), InputError);
  expect_same(live.scene(), loaded(0.4, {.lights = {{"*", Color::Constant(2.0f)}}}));
}

}  // namespace
}  // namespace gatelight::apps
