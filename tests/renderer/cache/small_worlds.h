#pragma once
// Scenes with closed forms for the light that the cache learns, and views of them.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "renderer/film/camera.h"
#include "renderer/film/film.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"
#include "tests/support/scene_builder.h"

namespace gatelight::testing {

/// A camera at `eye`, looking at `target`.
inline scene::Camera view_from(const Vec3& eye, const Vec3& target, float vertical_fov = 0.9f) {
  const Vec3 back = (eye - target).normalized();
  const Vec3 up = std::abs(back.y()) > 0.99f ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  scene::Camera camera;
  camera.transform.linear().col(0) = up.cross(back).normalized();
  camera.transform.linear().col(1) = back.cross(camera.transform.linear().col(0));
  camera.transform.linear().col(2) = back;
  camera.transform.translation() = eye;
  camera.vertical_fov = vertical_fov;
  return camera;
}

/// A closed box of one matte material that emits light: the radiance of every point is Le / (1 - a).
inline SceneBuilder closed_furnace(float albedo, float emission) {
  SceneBuilder builder;
  const int m = builder.material(SceneBuilder::lambert(Color::Constant(albedo), Color::Constant(emission)));
  builder.box(m, Vec3(-2, -1, -3), Vec3(2, 2, 3), true);
  builder.scene().cameras.push_back(view_from(Vec3(0.3f, 0.5f, 2.5f), Vec3::Zero()));
  return builder;
}

/// A scene, its world, and its first camera for a picture of 64 x 48 pixels.
struct ViewedWorld {
  explicit ViewedWorld(const SceneBuilder& made, const renderer::EnvironmentOptions& sky = {})
      : builder(made),
        world(builder.scene(), {.environment = sky}),
        camera(builder.scene().cameras.at(0), region.width(), region.height()) {}

  SceneBuilder builder;
  renderer::World world;
  renderer::PixelRect region{0, 0, 64, 48};
  renderer::Camera camera;
};

/// Runs the function in an arena of this number of threads, even with fewer processors.
template <typename Function>
void with_threads(int threads, Function function) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute(function);
}

}  // namespace gatelight::testing
