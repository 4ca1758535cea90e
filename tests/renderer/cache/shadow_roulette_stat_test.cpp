// Russian roulette of weak light samples changes neither the mean of pictures nor that of record targets.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/cache/cached_paths.h"
#include "renderer/transport/path_integrator.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;
using testing::ViewedWorld;

constexpr int kBatches = 400;
constexpr std::uint32_t kSamples = 256;

/// A glossy ball, a pane of smooth glass and a box on a floor, under a large dim lamp, many small ones and a
/// point light.
SceneBuilder many_lamps() {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color(0.7f, 0.6f, 0.5f)));
  builder.quad(matte, Vec3(-3, 0, 3), Vec3(6, 0, 0), Vec3(0, 0, -6));
  builder.box(matte, Vec3(0.4f, 0.001f, -0.5f), Vec3(1.2f, 0.9f, 0.3f));
  scene::Material glossy;
  glossy.base_color = Color(0.2f, 0.3f, 0.6f);
  glossy.roughness = 0.4f;
  glossy.clearcoat = 0.5f;
  builder.sphere(builder.material(glossy), Vec3(-0.8f, 0.6f, 0), 0.6f, 32, true);
  scene::Material pane;
  pane.transmission = 1.0f;
  pane.roughness = 0.0f;
  pane.double_sided = true;
  builder.quad(builder.material(pane), Vec3(-1.5f, 0.0f, 1.0f), Vec3(3, 0, 0), Vec3(0, 1.5f, 0));
  const auto lamp = [&](const Color& radiance) {
    return builder.material(SceneBuilder::lambert(Color::Zero(), radiance));
  };
  builder.quad(lamp(Color::Constant(0.8f)), Vec3(-2, 3, -2), Vec3(4, 0, 0), Vec3(0, 0, 3));
  for (int i = 0; i < 30; ++i) {
    const float a = 0.2f * static_cast<float>(i);
    const Vec3 p(2.0f * std::cos(a), 0.3f + 0.05f * static_cast<float>(i), 2.0f * std::sin(a) - 0.5f);
    builder.box(lamp(Color(1.0f, 4.0f, 2.0f)), p, p + Vec3::Constant(0.08f));
  }
  builder.scene().lights = {testing::point_light(Vec3(1.5f, 2.0f, 1.5f), Color(0.6f, 0.6f, 1.2f))};
  builder.scene().cameras.push_back(testing::view_from(Vec3(0.3f, 1.2f, 3.5f), Vec3(0, 0.5f, 0)));
  return builder;
}

struct Result {
  std::vector<Moments> means = std::vector<Moments>(3);  ///< of batches
  RayCounts rays;
};

void expect_same_means(const Result& all, const Result& some, double fewer) {
  EXPECT_LT(static_cast<double>(some.rays.shadow), fewer * static_cast<double>(all.rays.shadow));
  for (std::size_t c = 0; c < 3; ++c) {
    const double error = std::hypot(all.means[c].standard_error(), some.means[c].standard_error());
    EXPECT_GT(all.means[c].mean(), 20.0 * error);
    EXPECT_LT(std::abs(all.means[c].mean() - some.means[c].mean()), 4.5 * error) << "channel " << c;
  }
}

std::vector<CameraSample> samples_of(const ViewedWorld& viewed, std::uint32_t batch, std::uint32_t seed,
                                     float threshold) {
  std::vector<CameraSample> samples;
  for (std::uint32_t i = 0; i < kSamples; ++i) {
    CameraSample s;
    s.sampler = Sampler(SamplerKind::independent, seed, i, batch, 0);
    s.seed = hash(hash(hash(seed) + i) + batch);
    s.contribution_threshold = threshold;
    const Vec2 u = s.sampler.get_2d(dimension::kFilm);
    s.camera_ray = viewed.camera.ray(64.0f * u.x(), 48.0f * u.y());
    samples.push_back(s);
  }
  return samples;
}

Result trace_picture(const ViewedWorld& viewed, std::uint32_t seed, float threshold) {
  const PathIntegrator integrator(viewed.world, path_integrator_options({}));
  PathIntegrator::Scratch scratch;
  Result result;
  std::vector<SampleResult> samples(kSamples);
  for (std::uint32_t b = 0; b < kBatches; ++b) {
    integrator.trace(samples_of(viewed, b, seed, threshold), samples, {}, result.rays, scratch);
    Color mean = Color::Zero();
    for (const SampleResult& s : samples) mean += s.radiance / kSamples;
    for (int c = 0; c < 3; ++c) result.means[static_cast<std::size_t>(c)].add(static_cast<double>(mean[c]));
  }
  return result;
}

/// The targets of the first records; those of deeper ones depend on them.
Result trace_records(const ViewedWorld& viewed, std::uint32_t seed, float threshold) {
  const StoredSurfaces stored;
  RenderOptions options;
  options.cache.component = CachedComponent::all;
  const CachedPaths paths(viewed.world, cached_paths_options(options), stored);
  CachedPaths::Scratch scratch;
  PathBatch batch{PointInputs()};
  PathPlan plan;
  plan.records = true;
  plan.contribution_threshold = threshold;
  Result result;
  for (std::uint32_t b = 0; b < kBatches; ++b) {
    std::vector<PathStart> starts;
    for (const CameraSample& s : samples_of(viewed, b, seed, 0.0f)) starts.push_back({s});
    paths.trace(starts, {}, plan, batch, {}, result.rays, scratch);
    batch.resolve({}, {});
    Color mean = Color::Zero();
    for (const std::int32_t record : batch.first_records) {
      if (record != kNone) mean += batch.target(record) / kSamples;
    }
    for (int c = 0; c < 3; ++c) result.means[static_cast<std::size_t>(c)].add(static_cast<double>(mean[c]));
  }
  return result;
}

TEST(ShadowRoulette, PicturesKeepTheirMean) {
  const ViewedWorld viewed(many_lamps());
  expect_same_means(trace_picture(viewed, 1, 0.0f), trace_picture(viewed, 2, 0.5f), 0.8);
}

TEST(ShadowRoulette, RecordsKeepTheirMean) {
  const ViewedWorld viewed(many_lamps());
  expect_same_means(trace_records(viewed, 3, 0.0f), trace_records(viewed, 4, 0.5f), 0.8);
}

TEST(ShadowRoulette, TheThresholdFollowsTheMeanOfThePixel) {
  Film film({0, 0, 2, 1}, 2, 1, {});
  EXPECT_EQ(film.contribution_threshold({0, 0}), 0.0f);
  for (int i = 0; i < 8; ++i) film.add(film.take({0, 0}), Color(1.0f, 2.0f, 0.5f));
  EXPECT_FLOAT_EQ(film.contribution_threshold({0, 0}), 0.6f);
  EXPECT_EQ(film.contribution_threshold({1, 0}), 0.0f);
}

}  // namespace
}  // namespace gatelight::renderer
