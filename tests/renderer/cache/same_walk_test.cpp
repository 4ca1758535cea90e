// Paths without cache queries equal the path tracer's, one by one: both integrators sum the light along the
// same PathState.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/cache/cached_paths.h"
#include "renderer/transport/path_integrator.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::ViewedWorld;

struct BothWays {
  std::vector<Color> path_tracer;
  std::vector<Color> cached_paths;
  RayCounts path_tracer_rays;
  RayCounts cached_paths_rays;
  std::vector<float> targets;  ///< of the records
};

BothWays trace(const ViewedWorld& viewed, int max_depth, int min_depth, bool records) {
  std::vector<CameraSample> samples;
  std::vector<PathStart> starts;
  for (std::uint32_t i = 0; i < 256; ++i) {
    CameraSample sample;
    sample.sampler = Sampler(SamplerKind::independent, 1, i, 0, 0);
    sample.seed = hash(i);
    sample.camera_ray =
        viewed.camera.ray(24.5f + static_cast<float>(i % 16), 16.5f + static_cast<float>(i / 16));
    samples.push_back(sample);
    starts.push_back({sample});
  }
  RenderOptions options;
  options.max_depth = max_depth;
  options.min_depth = min_depth;
  BothWays both;
  std::vector<SampleResult> results(samples.size());
  PathIntegrator::Scratch path_scratch;
  PathIntegrator(viewed.world, path_integrator_options(options))
      .trace(samples, results, {}, both.path_tracer_rays, path_scratch);
  for (const SampleResult& result : results) both.path_tracer.push_back(result.radiance);

  PathPlan plan;
  plan.records = records;
  plan.max_depth = max_depth;
  plan.min_depth = min_depth;
  const StoredSurfaces stored;
  PathBatch batch{PointInputs()};
  CachedPaths::Scratch scratch;
  CachedPaths(viewed.world, cached_paths_options(options), stored)
      .trace(starts, {}, plan, batch, {}, both.cached_paths_rays, scratch);
  both.cached_paths.resize(samples.size());
  batch.resolve({}, both.cached_paths);
  for (const float target : batch.targets) EXPECT_TRUE(std::isfinite(target));
  both.targets = batch.targets;
  return both;
}

void expect_same(const BothWays& both) {
  EXPECT_EQ(both.cached_paths_rays.bounce, both.path_tracer_rays.bounce);
  EXPECT_EQ(both.cached_paths_rays.shadow, both.path_tracer_rays.shadow);
  for (std::size_t i = 0; i < both.path_tracer.size(); ++i) {
    const float least = 1e-4f * (1e-3f + both.path_tracer[i].maxCoeff());
    ASSERT_LT((both.cached_paths[i] - both.path_tracer[i]).abs().maxCoeff(), least) << "path " << i;
  }
}

TEST(SameWalk, RouletteEndsPathsBehindThePanesOfTheLastDepth) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 10);
  scene::Material glass = SceneBuilder::clear_glass();
  glass.base_color = Color(0.7f, 0.8f, 0.9f);
  for (const float height : {1.0f, 1.1f, 1.2f, 1.3f}) testing::add_floor(builder, glass, 10, height);
  builder.scene().cameras.push_back(testing::view_from(Vec3(0, 0.9f, 0.5f), Vec3::Zero()));
  const ViewedWorld viewed(builder, {.constant = Color(1.0f, 2.0f, 3.0f)});
  const BothWays both = trace(viewed, 1, 0, true);
  expect_same(both);
  // Four panes for each path would be 256 * 5 rays.
  EXPECT_LT(both.path_tracer_rays.bounce, 256u * 4u);
}

/// Nested closed meshes of glass, which absorb nothing, in a white sky.
BothWays sheets(float ior, int layers, bool lamp_inside) {
  SceneBuilder builder;
  const int m = builder.material(testing::solid_glass(ior));
  for (int i = 0; i < layers; ++i) {
    const float half = 1.0f - static_cast<float>(i) / static_cast<float>(layers);
    builder.box(m, Vec3(-20, -20, -half), Vec3(20, 20, half));
  }
  if (lamp_inside) {
    const int lamp =
        builder.material(SceneBuilder::lambert(Color(0.5f, 0.4f, 0.3f), Color(1.0f, 2.0f, 3.0f)));
    builder.box(lamp, Vec3(-20, -20, -1e-3f), Vec3(20, 20, 1e-3f));
  }
  builder.scene().cameras.push_back(testing::view_from(Vec3(0, 0, 5), Vec3::Zero(), 0.2f));
  const ViewedWorld viewed(builder, {.constant = Color::Ones()});
  // Without roulette each path that leaves the glass has a radiance of exactly 1.
  return trace(viewed, 60000, 60000, true);
}

/// In equilibrium the radiance inside is that of the sky times the squared index of refraction.
TEST(SameWalk, ARecordInsideGlassLearnsTheRadianceInsideGlass) {
  SceneBuilder builder;
  builder.box(builder.material(testing::solid_glass()), Vec3(-20, -20, -1), Vec3(20, 20, 1));
  const int white = builder.material(SceneBuilder::lambert(Color::Ones()));
  builder.box(white, Vec3(-19, -19, -0.5f), Vec3(19, 19, 0.5f));
  builder.scene().cameras.push_back(testing::view_from(Vec3(0, 0, 5), Vec3::Zero(), 0.2f));
  const ViewedWorld viewed(builder, {.constant = Color::Ones()});
  const BothWays both = trace(viewed, 60000, 60000, true);
  expect_same(both);
  ASSERT_GT(both.targets.size(), 100u);
  for (const float target : both.targets) EXPECT_NEAR(target, 2.25f, 1e-3f);
}

TEST(SameWalk, NestedClosedMeshesLoseNoLight) {
  for (const float ior : {1.5f, 3.0f}) {
    const BothWays both = sheets(ior, 300, false);
    expect_same(both);
    for (const Color& radiance : both.cached_paths) EXPECT_NEAR(radiance.mean(), 1.0f, 0.01f) << ior;
  }
}

TEST(SameWalk, EmissionInsideNestedClosedMeshesIsNotARecord) {
  for (const int layers : {3, 300}) expect_same(sheets(1.5f, layers, true));
}

}  // namespace
}  // namespace gatelight::renderer
