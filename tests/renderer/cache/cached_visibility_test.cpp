// A cache learns what bounces see where the camera and shadow rays see other objects and lights.

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "renderer/render.h"
#include "tests/renderer/cache/cached_pictures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;

/// A room with a wall between camera and room that only bounces and shadow rays see, a lamp that all but the
/// camera see, and a bulb that lights the floor only.
scene::Scene room_behind_a_wall() {
  SceneBuilder builder = walls_and_mirror();
  scene::Scene& scene = builder.scene();
  builder.quad(0, Vec3(-2, 0, 2), Vec3(0, 3, 0), Vec3(4, 0, 0));
  scene.instances.back().visibility.rays = scene::kBounceRays | scene::kShadowRays;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(6.0f))),
               Vec3(-0.5f, 2.0f, 0.5f), Vec3(0, 0, -1), Vec3(1, 0, 0));
  scene.materials.back().double_sided = true;
  scene.instances.back().visibility.rays = scene::kBounceRays | scene::kShadowRays;
  scene.lights = {testing::point_light(Vec3(-1, 1.5f, 0), Color(2, 3, 4))};
  scene::ObjectSet floor{std::vector<std::uint8_t>(scene.instances.size(), 0), false};
  floor.instances[0] = 1;
  scene.object_sets = {floor};
  scene.lights[0].link.receivers = 0;
  return scene;
}

Moments means(const scene::Scene& scene, RenderOptions options, int seeds) {
  Moments means;
  for (int seed = 0; seed < seeds; ++seed) {
    options.seed = static_cast<std::uint32_t>(40 + seed);
    means.add(testing::moments_of(Renderer(scene, options).render()).mean());
  }
  return means;
}

TEST(CachedVisibility, HasTheLightOfPaths) {
  scene::Scene scene = room_behind_a_wall();
  RenderOptions options = cached_picture(Integrator::nrc);
  options.width = 48;
  options.height = 36;
  options.cache.train_steps = 150;
  options.spp = 8;
  RenderOptions paths = options;
  paths.integrator = Integrator::path;
  paths.spp = 64;
  const double expected = means(scene, paths, 4).mean();
  for (const CachedComponent component :
       {CachedComponent::all, CachedComponent::no_delta, CachedComponent::indirect}) {
    options.cache.component = component;
    EXPECT_NEAR(means(scene, options, 4).mean(), expected, 0.01 * expected) << static_cast<int>(component);
  }
  // The rules change much more than that.
  const auto changed = [&](const std::function<void()>& change) {
    scene = room_behind_a_wall();
    change();
    EXPECT_GT(std::abs(means(scene, paths, 1).mean() - expected), 0.05 * expected);
  };
  for (const std::size_t i : {3u, 4u}) {
    changed([&] { scene.instances[i].visibility.rays = scene::kAllRays; });
    changed([&] { scene.instances[i].visibility.rays = scene::kCameraRays; });
  }
  changed([&] { scene.lights[0].link = {}; });
}

}  // namespace
}  // namespace gatelight::renderer
