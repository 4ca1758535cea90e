// Whether a soft sky lights scenes that glow: what a person expects, in any run.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/render.h"
#include "tests/renderer/driver/glowing_scenes.h"
#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using tests::expect_messages;
using tests::GlowingScene;
using tests::GlowingSet;

RenderOptions options_of(const GlowingScene& row) {
  RenderOptions options;
  options.width = 160;
  options.height = 90;
  options.spp = 16;
  options.glass_shadows = GlassShadows::straight;
  options.environment.automatic = true;
  options.camera.look_at = LookAt{row.eye, row.target, Vec3(0, 1, 0)};
  return options;
}

TEST(SoftSkyChoice, IsWhatAPersonExpects) {
  for (const GlowingScene& row : tests::glowing_scenes()) {
    GlowingSet set;
    row.build(set);
    Renderer renderer(set.scene(), options_of(row));
    EXPECT_EQ(renderer.soft_sky(), row.sky) << row.name;
  }
}

/// A cube whose badge lights only a lip.
scene::Scene badge() {
  GlowingSet set;
  set.cube_with_badge(1);
  set.block(set.matte(0.5f), {0.3f, 0.05f, 1.06f}, 0.6f, 0.06f, 0.12f);
  return set.scene();
}

scene::Scene lamp() {
  GlowingSet set;
  set.room_with_lamp(12);
  return set.scene();
}

RenderOptions from(const Vec3& eye) {
  return options_of({.name = "", .sky = false, .eye = eye, .target = Vec3::Zero(), .build = {}});
}
const Vec3 kBeforeTheBadge(1.5f, 1.2f, 3.5f), kInTheRoom(0, 1.6f, 2.3f);

/// The share of the pixels that meet the scene and are black.
double black_share(const Picture& picture) {
  const std::vector<float>& light = picture.layers[0].values;
  const std::vector<float>& depth = picture.find("depth")->values;
  int black = 0, all = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (!std::isfinite(depth[i])) continue;
    ++all;
    black += light[3 * i + 1] < 1e-3f ? 1 : 0;
  }
  return static_cast<double>(black) / all;
}

TEST(SoftSkyChoice, AGlowingBadgeDoesNotLeaveItsCubeBlack) {
  const scene::Scene cube = badge();
  RenderOptions options = from(kBeforeTheBadge);
  options.aovs = {Aov::depth};
  Renderer lit(cube, options);
  expect_messages(lit.statistics().warnings,
                  {{"built.glb", "no light that illuminates", "soft sky", "none"}});
  EXPECT_LT(black_share(lit.render()), 0.01);
  options.environment.automatic = false;
  Renderer dark(cube, options);
  EXPECT_TRUE(dark.statistics().warnings.empty());
  EXPECT_EQ(dark.soft_sky(), std::nullopt);
  EXPECT_GT(black_share(dark.render()), 0.9);
}

TEST(SoftSkyChoice, AFaintGlowOfAnObjectsOwnDoesNotSwitchItOff) {
  for (const float glow : {0.001f, 0.1f}) {
    tests::GlowingSet figure;
    figure.ball(figure.glow(glow, Color::Ones(), 0.5f), Vec3::Zero(), 1.0f);
    RenderOptions options;
    options.width = 48;
    options.height = 27;
    options.spp = 1;
    options.environment.automatic = true;
    EXPECT_EQ(Renderer(figure.scene(), options).soft_sky(), true) << glow;
  }
}

TEST(SoftSkyChoice, ALampInARoomKeepsItsPicture) {
  const scene::Scene room = lamp();
  RenderOptions options = from(kInTheRoom);
  Renderer automatic(room, options);
  EXPECT_TRUE(automatic.statistics().warnings.empty());
  options.environment.automatic = false;
  EXPECT_EQ(automatic.render().layers[0].values, Renderer(room, options).render().layers[0].values);
  options.environment.automatic = true;
  scene::Scene with_light = room;
  with_light.lights.emplace_back().intensity = Color::Zero();
  EXPECT_EQ(Renderer(with_light, options).soft_sky(), std::nullopt);
}

// Of the last scenes that the table finds on either side.
TEST(SoftSkyChoice, IsTheSameInAnyRun) {
  for (const GlowingScene& row : tests::glowing_scenes()) {
    if (row.name != "monitor on a desk" && row.name != "robot with eyes") continue;
    GlowingSet set;
    row.build(set);
    std::vector<RenderOptions> runs(5, options_of(row));
    runs[0].seed = 7;
    runs[1].threads = 1;
    runs[2].threads = 3;
    runs[3].width = 640, runs[3].height = 360;
    runs[4].width = 100, runs[4].height = 56;
    for (const RenderOptions& options : runs) EXPECT_EQ(Renderer(set.scene(), options).soft_sky(), row.sky);
  }
}

TEST(SoftSkyChoice, BelongsToTheViewUnlessItIsKept) {
  scene::Scene cube = badge();
  cube.motion.materials = true;
  const auto whites = [](const Picture& p) {
    return *std::max_element(p.layers[0].values.begin(), p.layers[0].values.end());
  };
  const CameraOptions whole = from(kBeforeTheBadge).camera;
  RenderOptions near = from(Vec3(0.3f, 0.3f, 1.5f));  // sees hardly more than the badge
  near.camera.look_at->target = Vec3(0.3f, 0.3f, 0);
  near.camera.fov_degrees = 20.0f;
  Renderer renderer(cube, near);
  EXPECT_EQ(renderer.soft_sky(), false);
  renderer.set_camera(whole);
  EXPECT_EQ(renderer.soft_sky(), true);
  renderer.keep_soft_sky(false);
  renderer.scene_moved(whole);
  EXPECT_EQ(renderer.soft_sky(), false);
  EXPECT_LE(whites(renderer.render()), 1.0f);
  // A lamp that is off is no reason for a sky while the choice is kept.
  for (scene::Material& m : cube.materials) m.emission = Color::Zero();
  renderer.scene_moved(whole);
  EXPECT_EQ(whites(renderer.render()), 0.0f);
  EXPECT_TRUE(renderer.statistics().warnings.empty());
  renderer.keep_soft_sky({});
  renderer.set_options(from(kBeforeTheBadge));
  EXPECT_EQ(renderer.soft_sky(), true);
}

// A group may name the sky, which is not there while the view is judged.
TEST(SoftSkyChoice, KnowsTheGroupsOfLights) {
  const scene::Scene cube = badge();
  RenderOptions options = from(kBeforeTheBadge);
  options.light_groups = {{.name = "sky", .lights = {kEnvironmentWord}}};
  const Picture picture = Renderer(cube, options).render();
  EXPECT_NE(picture.find("light-sky"), nullptr);
}

}  // namespace
}  // namespace gatelight::renderer
