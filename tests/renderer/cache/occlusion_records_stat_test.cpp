// Records of openness are right in the mean: closed forms, and the reference integrator.

#include <gtest/gtest.h>

#include "renderer/cache/occlusion_records.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

const double kOcclusionSignificance = testing::sidak(1e-4, 20);

Moments targets(const ViewedWorld& viewed, float distance, std::size_t points, int times = 1) {
  RenderOptions options;
  options.sampler = SamplerKind::independent;
  options.cache.samples_per_point = times;
  const TrainingPoints chosen(viewed.world, viewed.camera, viewed.region, options, {}, nullptr);
  const StoredSurfaces stored;
  OcclusionRecords records(viewed.world, chosen, options, stored, distance, {});
  RecordBatch batch;
  const RecordRequest request{.step = 1, .points = points};
  records.begin(request, batch);
  records.trace(batch);
  records.split(request, batch);
  Moments moments;
  for (const float t : batch.targets) moments.add(static_cast<double>(t));
  return moments;
}

void expect_mean_visibility(const Moments& m, double expected) {
  EXPECT_GT(m.count(), 500u);
  EXPECT_GT(testing::mean_p_value(m, expected), kOcclusionSignificance)
      << "mean " << m.mean() << " +- " << m.standard_error() << ", expected " << expected;
}

TEST(OcclusionRecordsStat, NothingOccludesAPlane) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 90);
  builder.scene().cameras.push_back(view_from(Vec3(0, 1, 0), Vec3(0, 0, 0)));
  const ViewedWorld viewed(builder);
  expect_mean_visibility(targets(viewed, kInfinity, 1000), 1.0);
}

TEST(OcclusionRecordsStat, AClosedRoomIsFullyOccluded) {
  const ViewedWorld viewed(testing::closed_furnace(0.5f, 1.0f));
  const Moments m = targets(viewed, kInfinity, 2000);
  expect_mean_visibility(m, 0.0);
  EXPECT_EQ(m.variance(), 0.0);
}

/// Floor and ceiling, one metre apart.
SceneBuilder slab() {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(matte, Vec3(-9, 0, 9), Vec3(18, 0, 0), Vec3(0, 0, -18));
  builder.quad(matte, Vec3(-9, 1, -9), Vec3(18, 0, 0), Vec3(0, 0, 18));
  builder.scene().cameras.push_back(view_from(Vec3(0, 0.5f, 0), Vec3(0, 0, 0)));
  return builder;
}

TEST(OcclusionRecordsStat, ACeilingOccludesByItsDistance) {
  const ViewedWorld viewed(slab());
  // A ray with the cosine c reaches the ceiling after 1 / c metres; c^2 is uniform.
  expect_mean_visibility(targets(viewed, 2.0f, 6000), 0.25);
  expect_mean_visibility(targets(viewed, 1.25f, 6000), 0.64);
  expect_mean_visibility(targets(viewed, 0.9f, 1000), 1.0);
}

TEST(OcclusionRecordsStat, SamplesOfAPointAreAveraged) {
  const ViewedWorld viewed(slab());
  const Moments m = targets(viewed, 2.0f, 3000, 16);
  EXPECT_NEAR(static_cast<double>(m.count()), 3000.0, 60.0);
  expect_mean_visibility(m, 0.25);
  // The targets are binomial with 16 trials; the standard deviation of the variance is 2.6 percent.
  EXPECT_NEAR(m.variance() / (0.25 * 0.75 / 16.0), 1.0, 0.12);
}

TEST(OcclusionRecordsStat, TheReferenceIntegratorAgrees) {
  SceneBuilder builder = slab();
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.2f)));
  builder.sphere(matte, Vec3(0.3f, 0.3f, -0.6f), 0.3f, 24, true);
  scene::Material veil = SceneBuilder::lambert(Color::Constant(0.5f));
  veil.alpha_mode = scene::AlphaMode::blend;
  veil.base_alpha = 0.4f;
  builder.quad(builder.material(veil), Vec3(-1, 0.2f, -0.3f), Vec3(1, 0, 0), Vec3(0, 0.5f, 0));
  builder.scene().cameras[0] = view_from(Vec3(0, 0.6f, 1.5f), Vec3(0, 0.3f, -1));
  const ViewedWorld viewed(builder);
  constexpr float kDistance = 0.8f;

  const AoIntegrator reference(viewed.world, kDistance);
  std::vector<CameraSample> samples(64 * 48 * 8);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    CameraSample& s = samples[i];
    s.sampler = Sampler(SamplerKind::independent, 99, i, 0, 0);
    s.seed = hash(i + 12345u);
    const Vec2 film = s.sampler.get_2d(dimension::kFilm);
    s.camera_ray =
        viewed.camera.ray(static_cast<float>(i % 64) + film.x(), static_cast<float>(i / 64 % 48) + film.y());
  }
  std::vector<SampleResult> results(samples.size());
  std::vector<FirstHit> first(samples.size());
  AoIntegrator::Scratch scratch;
  RayCounts rays;
  reference.trace(samples, results, first, rays, scratch);
  Moments expected;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (first[i].hit) expected.add(static_cast<double>(results[i].radiance.y()));
  }
  const Moments m = targets(viewed, kDistance, 24000);
  const double error = std::hypot(m.standard_error(), expected.standard_error());
  EXPECT_GT(testing::normal_two_sided((m.mean() - expected.mean()) / error), kOcclusionSignificance)
      << m.mean() << " against " << expected.mean() << " +- " << error;
  EXPECT_LT(m.mean(), 0.95);
}

}  // namespace
}  // namespace gatelight::renderer
