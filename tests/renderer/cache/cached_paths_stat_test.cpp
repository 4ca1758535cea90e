// Paths that end in the cache, in scenes where their radiance has a closed form: reflections that roulette
// leaves out, media that absorb.

#include "renderer/cache/cached_paths.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;

constexpr double kSky = 2.0;
const double kPathSignificance = testing::sidak(1e-4, 4);

/// Traces `paths` paths from (0, 5, 0) down, below a sky of kSky.
PathBatch look_down(const scene::Scene& scene, const PathPlan& plan, std::size_t paths) {
  const World world(scene, {.environment = {.constant = Color::Constant(static_cast<float>(kSky))}});
  RenderOptions options;
  options.cache.component = CachedComponent::all;
  std::vector<PathStart> starts(paths);
  for (std::uint32_t i = 0; i < starts.size(); ++i) {
    CameraSample& sample = starts[i].sample;
    sample.sampler = Sampler(SamplerKind::independent, 1, i, 0, 0);
    sample.seed = hash(i);
    sample.camera_ray.ray.origin = Vec3(0, 5, 0);
    sample.camera_ray.ray.direction = Vec3(0, -1, 0);
  }
  const StoredSurfaces stored;
  PathBatch batch{PointInputs{}};
  RayCounts rays;
  CachedPaths::Scratch scratch;
  CachedPaths(world, cached_paths_options(options), stored).trace(starts, {}, plan, batch, {}, rays, scratch);
  return batch;
}

/// Radiance in green, where the cache answers every query with `answer`.
Moments radiance_of(PathBatch batch, float answer) {
  std::vector<Color> radiance(batch.paths());
  batch.resolve(std::vector<float>(3 * batch.queries.size(), answer), radiance);
  Moments moments;
  for (const Color& r : radiance) moments.add(static_cast<double>(r.y()));
  return moments;
}

void expect_mean(const Moments& moments, double expected, double rounding) {
  EXPECT_GT(testing::mean_p_value(moments, expected, rounding), kPathSignificance)
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

/// Half the side of floors. Light from beyond their edges arrives at too flat an angle to count.
constexpr float kHalf = 50.0f;

TEST(CachedPaths, ReflectionsOfAWeakVarnishAreRightInTheMean) {
  scene::Material varnished;
  varnished.base_color = Color::Constant(0.5f);
  varnished.metallic = 0.0f;
  varnished.roughness = 0.0f;
  varnished.specular = 0.1f;  // of the 4 % of an index of 1.5: few reflected paths are followed
  SceneBuilder builder;
  testing::add_floor(builder, varnished, kHalf);
  PathPlan plan;
  plan.query_at = QueryAt::primary;
  const PathBatch batch = look_down(builder.scene(), plan, 20000);
  EXPECT_EQ(batch.queries.size(), 20000u);
  const Moments moments = radiance_of(batch, 0.0f);
  EXPECT_GT(moments.variance(), 0.0) << "all paths are followed, so roulette is not tested";
  expect_mean(moments, 0.004 * kSky, 1e-5);
}

constexpr double kDepth = 0.8;
constexpr double kAbsorbed = 0.9;  ///< per metre, of green

/// A medium that light enters unrefracted, above this floor.
SceneBuilder pool(const scene::Material& floor) {
  scene::Material water = testing::solid_glass(1.0f);
  water.attenuation_distance = 1.0f;
  water.attenuation_color = Color(0.2f, static_cast<float>(std::exp(-kAbsorbed)), 0.9f);
  SceneBuilder builder;
  testing::add_floor(builder, water, kHalf, static_cast<float>(kDepth));
  testing::add_floor(builder, floor, kHalf);
  return builder;
}

TEST(CachedPaths, AnswersInAMediumAreAbsorbedOnTheirWay) {
  PathPlan plan;
  plan.query_at = QueryAt::primary;
  const PathBatch batch = look_down(pool(SceneBuilder::lambert(Color::Constant(0.5f))).scene(), plan, 200);
  EXPECT_EQ(batch.queries.size(), 200u);
  expect_mean(radiance_of(batch, 3.0f), std::exp(-kAbsorbed * kDepth) * 0.5 * 3.0, 1e-3);
}

TEST(CachedPaths, LampsInAMediumAreAbsorbedOnTheirWay) {
  const PathBatch batch =
      look_down(pool(SceneBuilder::lambert(Color::Zero(), Color::Constant(3.0f))).scene(), {}, 200);
  expect_mean(radiance_of(batch, 0.0f), std::exp(-kAbsorbed * kDepth) * 3.0, 1e-3);
}

TEST(CachedPaths, TargetsInAMediumAreAbsorbedOnTheirWay) {
  PathPlan plan;
  plan.records = true;
  PathBatch batch = look_down(pool(SceneBuilder::lambert(Color::Constant(0.5f))).scene(), plan, 20000);
  batch.resolve({}, {});
  ASSERT_EQ(batch.records.size(), 20000u);
  Moments targets;
  for (std::size_t i = 0; i < batch.records.size(); ++i)
    targets.add(static_cast<double>(batch.targets[3 * i + 1]));
  // The mean over the cosine-weighted directions, whose cosine's square is uniform.
  const double expected = testing::integrate(
      [](double square) { return kSky * std::exp(-kAbsorbed * kDepth / std::sqrt(square)); }, 1e-9, 1.0, 200);
  expect_mean(targets, expected, 1e-3);
}

}  // namespace
}  // namespace gatelight::renderer
