// The light that the cache stores has one definition. A cache that answers every query with one fresh record,
// traced from the same point, is right in the mean: pictures made with it must have the path tracer's mean,
// whatever the cache stores and wherever it is queried. If targets, ends and composition disagree, the means
// differ.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "renderer/cache/cached_paths.h"
#include "renderer/film/camera.h"
#include "renderer/transport/path_integrator.h"
#include "renderer/transport/world.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;

constexpr int kSide = 64;
const double kLightSignificance = testing::sidak(1e-4, 150);

/// Every kind of surface (matte, plastic, rough and smooth metal, mirror, pane, lacquer, rough and smooth
/// glass, matte inside glass) under every kind of light.
SceneBuilder mixed_scene() {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color(0.7f, 0.5f, 0.4f)), 3);
  scene::Material wall;
  wall.base_color = Color(0.3f, 0.6f, 0.4f);
  wall.metallic = 0.0f;
  wall.roughness = 0.15f;  // a matte base below a narrow layer
  builder.quad(builder.material(wall), Vec3(-3, 0, -2), Vec3(6, 0, 0), Vec3(0, 3, 0));
  scene::Material metal;
  metal.base_color = Color(0.9f, 0.7f, 0.5f);
  metal.roughness = 0.25f;
  builder.sphere(builder.material(metal), Vec3(-1.2f, 0.5f, 0.2f), 0.5f, 24, true);
  metal.roughness = 0.6f;
  builder.sphere(builder.material(metal), Vec3(1.3f, 0.5f, -0.6f), 0.5f, 24, true);
  metal.roughness = 0.0f;
  builder.quad(builder.material(metal), Vec3(-2.5f, 0.2f, -1.5f), Vec3(1.2f, 0, -0.4f), Vec3(0, 1.6f, 0));
  scene::Material lacquer = SceneBuilder::lambert(Color(0.5f, 0.1f, 0.1f));
  lacquer.clearcoat = 1.0f;
  lacquer.clearcoat_roughness = 0.1f;
  builder.box(builder.material(lacquer), Vec3(-0.3f, 0.001f, 0.2f), Vec3(0.4f, 0.6f, 0.8f));
  scene::Material pane;
  pane.metallic = 0.0f;
  pane.roughness = 0.0f;
  pane.transmission = 0.8f;  // the rest is a matte layer on the glass
  pane.base_color = Color(0.8f, 0.9f, 1.0f);
  pane.double_sided = true;
  builder.quad(builder.material(pane), Vec3(0.5f, 0, 1.2f), Vec3(1.0f, 0, 0.2f), Vec3(0, 1.2f, 0));
  builder.sphere(builder.material(testing::solid_glass()), Vec3(-1.0f, 0.45f, 1.7f), 0.4f, 24, true);
  builder.sphere(builder.material(SceneBuilder::lambert(Color(0.8f, 0.8f, 0.3f))), Vec3(-1.0f, 0.4f, 1.7f),
                 0.2f, 16, true);
  builder.sphere(builder.material(testing::solid_glass(1.5f, 0.6f)), Vec3(0.2f, 0.35f, 1.9f), 0.3f, 24, true);
  const int lamp = builder.material(SceneBuilder::lambert(Color(0.2f, 0.2f, 0.2f), Color(4.0f, 3.0f, 2.0f)));
  builder.quad(lamp, Vec3(-1, 2.9f, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
  builder.scene().lights = {testing::point_light(Vec3(1.5f, 2.0f, 1.5f), Color(1.0f, 1.5f, 2.0f)),
                            testing::sun(Vec3(-0.4f, -1.0f, -0.3f), Color(0.8f, 0.7f, 0.5f))};
  return builder;
}

struct Setting {
  CachedComponent holds;
  QueryAt query_at;
  float min_roughness;
};

std::string name_of(const Setting& s) {
  const char* const holds[] = {"All", "NoDelta", "Indirect"};
  const char* const at[] = {"Primary", "Gather", "Spread"};
  return std::string(holds[static_cast<std::size_t>(s.holds)]) + at[static_cast<std::size_t>(s.query_at)] +
         (s.min_roughness > 0.0f ? "NarrowLobesTraced" : "DeltasTraced");
}

class Pictures {
 public:
  Pictures()
      : builder_(mixed_scene()),
        world_(builder_.scene(), {.environment = {.constant = Color(0.1f, 0.2f, 0.4f)}}),
        camera_(view(), kSide, kSide) {
    options_.max_depth = 16;
  }

  RenderOptions options(const Setting& setting) const {
    RenderOptions options = options_;
    options.cache.component = setting.holds;
    options.cache.query_at = setting.query_at;
    options.cache.min_roughness = setting.min_roughness;
    return options;
  }

  std::vector<PathStart> starts(std::uint32_t seed, int samples) const {
    std::vector<PathStart> starts;
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(kSide * kSide * samples); ++i) {
      PathStart start;
      start.sample.sampler = Sampler(SamplerKind::independent, seed, i, 0, 0);
      start.sample.seed = hash(hash(seed) + i);
      const Vec2 film = start.sample.sampler.get_2d(dimension::kFilm);
      start.sample.camera_ray = camera_.ray(static_cast<float>(i % kSide) + film.x(),
                                            static_cast<float>(i / kSide % kSide) + film.y());
      starts.push_back(start);
    }
    return starts;
  }

  std::vector<Color> reference(std::uint32_t seed, int samples) const {
    const PathIntegrator integrator(world_, path_integrator_options(options_));
    std::vector<CameraSample> camera_samples;
    for (const PathStart& s : starts(seed, samples)) camera_samples.push_back(s.sample);
    std::vector<SampleResult> results(camera_samples.size());
    PathIntegrator::Scratch scratch;
    RayCounts rays;
    integrator.trace(camera_samples, results, {}, rays, scratch);
    std::vector<Color> radiance;
    for (const SampleResult& r : results) radiance.push_back(r.radiance);
    return radiance;
  }

  /// Radiance of paths composed by one setting, with answers that are records of another.
  std::vector<Color> answered(const Setting& composed, const Setting& learned, std::uint32_t seed,
                              int samples) const {
    PathPlan plan;
    plan.query_at = composed.query_at;
    PathBatch batch = trace(composed, plan, starts(seed, samples), {});
    std::vector<Color> radiance(batch.paths());
    batch.resolve(fresh_records(batch.queries, learned, seed), radiance);
    return radiance;
  }

  /// Radiance of training samples: paths to their end, of which a record is replaced by another one at the
  /// same point.
  std::vector<Color> taught(const Setting& setting, std::uint32_t seed, int samples) const {
    PathPlan plan;
    plan.records = true;
    plan.samples_at = setting.query_at;
    PathBatch batch = trace(setting, plan, starts(seed, samples), {});
    std::vector<Color> radiance(batch.paths());
    batch.resolve({}, radiance);
    SurfacePoints ends(inputs());
    ends.resize(batch.count_ends());
    batch.copy_ends(ends, 0);
    batch.end_samples(fresh_records(ends, setting, seed), radiance);
    return radiance;
  }

 private:
  static PointInputs inputs() {
    PointInputs inputs;
    inputs.directions = true;
    inputs.positions = true;
    return inputs;
  }

  PathBatch trace(const Setting& setting, PathPlan plan, const std::vector<PathStart>& starting,
                  const std::vector<Hit>& hits) const {
    const StoredSurfaces stored;
    RayCounts rays;
    CachedPaths::Scratch scratch;
    PathBatch batch(inputs());
    plan.max_depth = 16;
    CachedPaths(world_, cached_paths_options(options(setting)), stored)
        .trace(starting, hits, plan, batch, {}, rays, scratch);
    return batch;
  }

  /// A record for each point, traced only for it.
  std::vector<float> fresh_records(const SurfacePoints& queried, const Setting& learned,
                                   std::uint32_t seed) const {
    PathPlan to_the_end;
    to_the_end.records = true;
    const neural::QueryBatch queries = queried.batch();
    std::vector<PathStart> points(queries.size);
    std::vector<Hit> hits(queries.size);
    for (std::uint32_t i = 0; i < queries.size; ++i) {
      const Vec3 position(queries.positions[i][0], queries.positions[i][1], queries.positions[i][2]);
      const Vec3 wo(queries.directions[i][0], queries.directions[i][1], queries.directions[i][2]);
      CameraSample& s = points[i].sample;
      s.sampler = Sampler(SamplerKind::independent, seed + 1, i, 1, 0);
      s.seed = hash(hash(seed + 1) + i);
      s.camera_ray.ray.origin = position + wo;
      s.camera_ray.ray.direction = -wo;
      hits[i] = {1.0f, queries.barycentrics[i][0], queries.barycentrics[i][1], queries.surfaces[i] / 2,
                 queries.triangles[i]};
    }
    PathBatch records = trace(learned, to_the_end, points, hits);
    records.resolve({}, {});
    std::vector<float> answers(3 * queries.size, 0.0f);
    for (std::size_t i = 0; i < queries.size; ++i) {
      if (records.first_records[i] == kNone) continue;
      std::copy_n(&records.targets[3 * static_cast<std::size_t>(records.first_records[i])], 3,
                  &answers[3 * i]);
    }
    return answers;
  }

  static scene::Camera view() {
    scene::Camera camera;
    camera.transform.translation() = Vec3(0.0f, 1.2f, 4.5f);
    camera.vertical_fov = 0.8f;
    return camera;
  }

  SceneBuilder builder_;
  World world_;
  Camera camera_;
  RenderOptions options_;
};

const Pictures& pictures() {
  static const Pictures made;
  return made;
}

std::array<Moments, 3> moments_of(const std::vector<Color>& samples) {
  std::array<Moments, 3> moments;
  for (const Color& s : samples) {
    for (int c = 0; c < 3; ++c) moments[static_cast<std::size_t>(c)].add(static_cast<double>(s[c]));
  }
  return moments;
}

/// Smallest p-value of the channels' z-tests for equal means.
double compare(const std::array<Moments, 3>& a, const std::array<Moments, 3>& b, std::string& what) {
  double least = 1.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double error = std::hypot(a[c].standard_error(), b[c].standard_error());
    least = std::min(least, testing::normal_two_sided((a[c].mean() - b[c].mean()) / error));
    what += std::to_string(a[c].mean()) + " against " + std::to_string(b[c].mean()) + " +- " +
            std::to_string(error) + "; ";
  }
  return least;
}

const std::array<Moments, 3>& reference_moments() {
  static const std::array<Moments, 3> moments = moments_of(pictures().reference(77, 48));
  return moments;
}

class CachedLight : public ::testing::TestWithParam<Setting> {};

TEST_P(CachedLight, CompositionWithUnbiasedAnswersHasThePathTracersMean) {
  std::string what;
  const auto moments = moments_of(pictures().answered(GetParam(), GetParam(), 1, 24));
  EXPECT_GT(compare(moments, reference_moments(), what), kLightSignificance) << what;
}

TEST_P(CachedLight, TrainingSamplesThatEndInUnbiasedAnswersHaveThePathTracersMean) {
  std::string what;
  const auto moments = moments_of(pictures().taught(GetParam(), 1, 24));
  EXPECT_GT(compare(moments, reference_moments(), what), kLightSignificance) << what;
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const CachedComponent holds :
       {CachedComponent::all, CachedComponent::no_delta, CachedComponent::indirect}) {
    for (const QueryAt at : {QueryAt::primary, QueryAt::gather, QueryAt::spread}) {
      for (const float roughness : {0.0f, 0.3f}) all.push_back({holds, at, roughness});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Settings, CachedLight, ::testing::ValuesIn(settings()),
                         [](const auto& setting) { return name_of(setting.param); });

TEST(CachedLightDefects, TargetsAndCompositionThatDisagreeAreDetected) {
  const CachedComponent every[] = {CachedComponent::all, CachedComponent::no_delta,
                                   CachedComponent::indirect};
  for (const CachedComponent composed : every) {
    for (const CachedComponent learned : every) {
      if (composed == learned) continue;
      std::string what;
      const auto moments = moments_of(
          pictures().answered({composed, QueryAt::primary, 0.3f}, {learned, QueryAt::primary, 0.3f}, 3, 24));
      EXPECT_LT(compare(moments, reference_moments(), what), kLightSignificance) << what;
    }
  }
}

TEST(CachedLightPaths, WithoutQueriesEveryPathEqualsThePathTracers) {
  const Setting setting{CachedComponent::no_delta, QueryAt::none, 0.3f};
  const std::vector<Color> expected = pictures().reference(5, 2);
  const std::vector<Color> traced = pictures().answered(setting, setting, 5, 2);
  ASSERT_EQ(traced.size(), expected.size());
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const float scale = 1e-3f + expected[i].maxCoeff();
    ASSERT_LT((traced[i] - expected[i]).abs().maxCoeff(), 1e-4f * scale) << "path " << i;
  }
}

}  // namespace
}  // namespace gatelight::renderer
