// Scenes of short and long light paths, dark rooms and bright suns, and what is chosen for them.

#include "renderer/driver/scene_choices.h"

#include <gtest/gtest.h>

#include "renderer/render.h"
#include "tests/support/room.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;

RenderOptions automatic() {
  RenderOptions options = testing::small_picture();
  options.integrator = Integrator::nrc;
  options.choose_integrator = true;
  options.spp = 2;
  options.spp_of_paths = 3;
  options.cache.train_steps = 2;
  options.cache.batch = 256;
  return options;
}

/// A square before the sky: each path that meets it has one bounce, into the sky.
scene::Scene open_square() {
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.9f))), Vec3(-50, -50, -5),
               Vec3(100, 0, 0), Vec3(0, 100, 0));
  return builder.scene();
}

/// A closed box around the camera: paths end only by roulette and depth.
scene::Scene white_room() {
  SceneBuilder builder;
  scene::Material wall = SceneBuilder::lambert(Color::Constant(0.9f), Color::Constant(0.1f));
  wall.double_sided = true;
  builder.box(builder.material(wall), Vec3(-2, -2, -2), Vec3(2, 2, 2));
  return builder.scene();
}

TEST(SceneChoices, IsPathWherePathsAreShortAndTheCacheInARoom) {
  RenderOptions options = automatic();
  options.camera.look_at = LookAt{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  const scene::Scene closed = white_room();
  Renderer room(closed, options);
  EXPECT_EQ(room.chosen().integrator, Integrator::nrc);
  EXPECT_GT(room.statistics().bounces_of_paths.value(), kBouncesForCache);
  options.environment.constant = Color::Ones();
  const scene::Scene square = open_square();
  Renderer open(square, options);
  EXPECT_EQ(open.chosen().integrator, Integrator::path);
  EXPECT_NEAR(open.statistics().bounces_of_paths.value(), 1.0, 0.01);
  open.render();
  EXPECT_EQ(open.statistics().spp, 3) << "paths get more samples in the same time";
  // A named integrator takes precedence.
  options.choose_integrator = false;
  Renderer named(square, options);
  EXPECT_EQ(named.chosen().integrator, Integrator::nrc);
  EXPECT_FALSE(named.statistics().bounces_of_paths);
}

TEST(SceneChoices, DependsOnlyOnTheScene) {
  const scene::Scene scene = testing::room();
  RenderOptions options = automatic();
  options.threads = 1;
  const double expected = Renderer(scene, options).statistics().bounces_of_paths.value();
  options.threads = 3;
  EXPECT_EQ(Renderer(scene, options).statistics().bounces_of_paths.value(), expected);
}

TEST(SceneChoices, IsTheCacheWhereItPaysOffOrACacheFileIsGiven) {
  RenderOptions options = automatic();
  const auto chosen = [&](double bounces, double walk) {
    return with_choices(options, {.bounces = bounces, .walk = walk});
  };
  EXPECT_EQ(chosen(1.0, 0.0).integrator, Integrator::path);
  EXPECT_EQ(chosen(1.0, 0.0).spp, 3);
  EXPECT_EQ(chosen(2.0, 0.0).integrator, Integrator::nrc);
  EXPECT_EQ(chosen(2.0, 0.0).spp, 2);
  EXPECT_EQ(chosen(2.0, 0.5).integrator, Integrator::path) << "a cache does not shorten walks in media";
  options.cache.cache_in = "kept.safetensors";
  EXPECT_EQ(chosen(1.0, 0.0).integrator, Integrator::nrc);
}

/// In the white room, or before the square, under a sky of this irradiance.
Renderer sunlit(const scene::Scene& scene, float irradiance, Watertight watertight) {
  RenderOptions options = automatic();
  options.choose_integrator = false;
  options.integrator = Integrator::path;
  options.watertight = watertight;
  options.environment.constant = Color::Constant(irradiance / kPi);
  options.camera.look_at = LookAt{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  return Renderer(scene, options);
}

TEST(SceneChoices, WallsAreWatertightIfLightBehindThemIsBright) {
  const scene::Scene closed = white_room(), square = open_square();
  const auto chosen = [](const scene::Scene& scene, float irradiance, Watertight watertight) {
    return sunlit(scene, irradiance, watertight).chosen().watertight;
  };
  EXPECT_EQ(chosen(closed, 1.0f, Watertight::automatic), Watertight::off) << "as bright as the room";
  EXPECT_EQ(chosen(closed, 1e6f, Watertight::automatic), Watertight::on);
  EXPECT_EQ(chosen(square, 1e6f, Watertight::automatic), Watertight::off) << "all of the light is in front";
  EXPECT_EQ(chosen(closed, 1e6f, Watertight::off), Watertight::off) << "a named choice takes precedence";
  const Renderer room = sunlit(closed, 1e6f, Watertight::automatic);
  EXPECT_GT(room.statistics().light_behind_walls.value(), 1e5);
  EXPECT_FALSE(sunlit(closed, 1e6f, Watertight::on).statistics().light_behind_walls);
}

TEST(SceneChoices, EachViewChoosesItsWalls) {
  const scene::Scene closed = white_room();
  Renderer room = sunlit(closed, 1e6f, Watertight::automatic);
  const Picture inside = room.render();
  CameraOptions camera;
  camera.look_at = LookAt{{0, 0, 9}, {0, 0, -1}, {0, 1, 0}};
  room.set_camera(camera);
  EXPECT_EQ(room.chosen().watertight, Watertight::off) << "the sky shines onto the walls";
  camera.look_at = LookAt{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}};
  room.set_camera(camera);
  EXPECT_EQ(room.chosen().watertight, Watertight::on);
  EXPECT_EQ(room.render().layers.front().values, inside.layers.front().values);
}

}  // namespace
}  // namespace gatelight::renderer
