// The targets of records are right in the mean: closed forms of the light that the cache stores.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/renderer/cache/made_records.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

const double kRadianceSignificance = testing::sidak(1e-4, 40);

/// One target a path: that of its record nearest to the camera.
Moments first_targets(const ViewedWorld& viewed, const RenderOptions& options, std::size_t points,
                      bool self_training = false, float answer = 0.0f) {
  const MadeRecords made(
      viewed, options, {.step = 3, .points = points, .self_training = self_training},
      {[&](const SurfacePoints&, std::span<float> a) { std::fill(a.begin(), a.end(), answer); }});
  Moments moments;
  for (const PathBatch& block : made.batch.paths) {
    for (const std::int32_t record : block.first_records) {
      if (record != kNone)
        moments.add(static_cast<double>(block.targets[3 * static_cast<std::size_t>(record) + 1]));
    }
  }
  return moments;
}

void expect_mean(const Moments& m, double expected, double rounding = 1e-5) {
  EXPECT_GT(m.count(), 100u);
  EXPECT_GT(testing::mean_p_value(m, expected, rounding), kRadianceSignificance)
      << "mean " << m.mean() << " +- " << m.standard_error() << ", expected " << expected;
}

RenderOptions deep() {
  RenderOptions options;
  options.max_depth = 64;
  options.sampler = SamplerKind::independent;
  return options;
}

constexpr float kAlbedo = 0.6f;
constexpr float kEmission = 1.5f;

/// Radiance of every point of the furnace: E + S.
constexpr double kSent = 1.5 / (1.0 - 0.6);

/// Cached light over the reflectance, in a furnace.
double cached_in_furnace(CachedComponent holds) {
  return holds == CachedComponent::indirect ? kSent - 1.5 : kSent;
}

class RadianceRecordsStat : public ::testing::TestWithParam<CachedComponent> {
 protected:
  RadianceRecordsStat() { options.cache.component = GetParam(); }

  const ViewedWorld furnace{testing::closed_furnace(kAlbedo, kEmission)};
  RenderOptions options = deep();
};

TEST_P(RadianceRecordsStat, TargetsOfAClosedFurnaceAreItsLight) {
  expect_mean(first_targets(furnace, options, 8000), cached_in_furnace(GetParam()));
}

TEST_P(RadianceRecordsStat, AveragedTargetsHaveTheSameMeanAndLessNoise) {
  options.cache.path_length = 2;
  // Two scattering events: emission reflected once or twice.
  const double expected = GetParam() == CachedComponent::indirect ? 0.6 * 1.5 : 1.5 + 0.6 * 1.5;
  double variance[2];
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    options.cache.samples_per_point = i == 0 ? 1 : 8;
    const MadeRecords made(furnace, options, {.step = 4, .points = 1000});
    const RecordBatch& batch = made.batch;
    // The averaged record of a point stands before its paths' others.
    Moments moments;
    std::size_t begin = 0;
    for (const PathBatch& block : batch.paths) {
      for (std::size_t p = 0; p < block.first_records.size(); p += i == 0 ? 1 : 8) {
        const auto first = static_cast<std::size_t>(block.first_records[p]);
        // Records that were dropped stood one a path before this one.
        const std::size_t dropped = i == 0 ? 0 : p - p / 8;
        moments.add(static_cast<double>(batch.targets[3 * (begin + first - dropped)]));
      }
      begin += block.records.size();
    }
    expect_mean(moments, expected);
    variance[i] = moments.variance();
  }
  EXPECT_NEAR(variance[1] / variance[0], 1.0 / 8.0, 0.03);
}

TEST_P(RadianceRecordsStat, SunAndSkyOverAPlaneGiveTheirCachedShare) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color(0.2f, 0.7f, 0.4f)), 500);
  builder.scene().cameras.push_back(view_from(Vec3(0, 2, 0), Vec3(0, 0, 0)));
  builder.scene().lights = {testing::sun(Vec3(0.6f, -0.8f, 0.0f), Color(1.0f, 2.0f, 3.0f))};
  const ViewedWorld viewed(builder, {.constant = Color(0.1f, 0.3f, 0.9f)});
  const double sunlight = 2.0 * 0.8 / M_PI;
  const double expected = GetParam() == CachedComponent::all        ? 0.3 + sunlight
                          : GetParam() == CachedComponent::no_delta ? 0.3
                                                                    : 0.0;
  expect_mean(first_targets(viewed, options, 4000), expected);
}

TEST_P(RadianceRecordsStat, TintedPanesWeightTheCachedLightBehindThem) {
  // A floor, a pane that reflects nothing, and a ceiling that shines: L(ceiling) = e + a tint L(floor),
  // L(floor) = b tint L(ceiling).
  constexpr double kTint = 0.5, kShine = 1.5, kCeiling = 0.8, kFloor = 0.6;
  SceneBuilder builder;
  const auto plane = [&](const scene::Material& material, float y) {
    testing::add_floor(builder, material, 500, y);
  };
  plane(SceneBuilder::lambert(Color::Constant(0.6f)), 0.0f);
  scene::Material pane;
  pane.metallic = pane.roughness = pane.specular = 0.0f;
  pane.transmission = 1.0f;
  pane.base_color = Color(0.25f, 0.5f, 0.75f);
  pane.double_sided = true;
  plane(pane, 1.0f);
  scene::Material ceiling = SceneBuilder::lambert(Color::Constant(0.8f), Color::Constant(1.5f));
  ceiling.double_sided = true;
  plane(ceiling, 2.0f);
  builder.scene().cameras.push_back(view_from(Vec3(0, 0.5f, 0), Vec3(0, 0, 0)));
  const ViewedWorld viewed(builder);
  options.direct = DirectLight::bsdf;  // so wide a lamp so near is beyond the digits of light samples
  const double light = kShine / (1.0 - kCeiling * kFloor * kTint * kTint);
  // Light that misses the ends of the planes is 1e-4 of all.
  expect_mean(first_targets(viewed, options, 8000),
              kTint * (GetParam() == CachedComponent::indirect ? light - kShine : light), 1e-4);
}

TEST_P(RadianceRecordsStat, FourScatteringEventsAreFourTermsOfTheSum) {
  for (const int length : {1, 4}) {
    options.cache.path_length = length;
    double expected = 0.0;
    for (int k = GetParam() == CachedComponent::indirect ? 1 : 0; k < length; ++k)
      expected += 1.5 * std::pow(0.6, k);
    const Moments m = first_targets(furnace, options, 8000);
    expect_mean(m, expected);
  }
}

TEST_P(RadianceRecordsStat, EndsInAnExactCacheKeepTheMean) {
  const double cached = cached_in_furnace(GetParam());
  for (const int vertices : {1, 2}) {
    options.cache.self_training.vertices = vertices;
    expect_mean(first_targets(furnace, options, 8000, true, static_cast<float>(cached)), cached);
  }
}

TEST_P(RadianceRecordsStat, AttenuationWeakensOnlyTheEnds) {
  options.cache.self_training.vertices = 1;
  options.cache.self_training.full_fraction = 0.0f;
  options.cache.self_training.attenuation = 0.25f;
  const double cached = cached_in_furnace(GetParam());
  // S of the second vertex: a quarter of the answer, with all light that is not cached.
  const double direct = GetParam() == CachedComponent::indirect ? 1.5 : 0.0;
  const double scattered = 0.6 * (0.25 * cached + direct);
  const double expected = GetParam() == CachedComponent::indirect ? scattered : 1.5 + scattered;
  expect_mean(first_targets(furnace, options, 8000, true, static_cast<float>(cached)), expected);
}

std::string name_of(CachedComponent holds) {
  const char* const names[] = {"All", "NoDelta", "Indirect"};
  return names[static_cast<std::size_t>(holds)];
}

INSTANTIATE_TEST_SUITE_P(Holds, RadianceRecordsStat,
                         ::testing::Values(CachedComponent::all, CachedComponent::no_delta,
                                           CachedComponent::indirect),
                         [](const auto& holds) { return name_of(holds.param); });

TEST(RadianceRecordsOfGlass, RecordsBehindReflectionAndRefractionAreNotMixed) {
  // Behind a half-mirroring pane lies a bright wall, before it a dark one: the records at each wall have its
  // own light.
  SceneBuilder builder;
  scene::Material pane = SceneBuilder::clear_glass();
  pane.ior = 3.0f;
  builder.quad(builder.material(pane), Vec3(-9, -9, 0), Vec3(18, 0, 0), Vec3(0, 18, 0));
  const int bright = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(bright, Vec3(-9, -9, -1), Vec3(18, 0, 0), Vec3(0, 18, 0));
  const int dark = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(dark, Vec3(9, -9, 5), Vec3(-18, 0, 0), Vec3(0, 18, 0));
  scene::PunctualLight lamp;
  lamp.position = Vec3(0, 0, -0.5f);
  lamp.type = scene::LightType::spot;
  lamp.direction = Vec3(0, 0, -1);
  lamp.intensity = Color::Constant(10.0f);
  lamp.cos_inner = 0.5f;
  lamp.cos_outer = 0.3f;
  builder.scene().lights = {lamp};
  builder.scene().cameras.push_back(view_from(Vec3(0, 0, 2), Vec3(0, 0, 0), 0.3f));
  const ViewedWorld viewed(builder);
  RenderOptions options = deep();
  options.cache.component = CachedComponent::all;
  options.cache.path_length = 2;  // the pane is no event, its reflection is one
  options.cache.samples_per_point = 8;
  const MadeRecords made(viewed, options, {.step = 4, .points = 400});
  Moments at_dark;
  Moments at_bright;
  for (std::size_t i = 0; i < made.batch.records.size(); ++i)
    (made.instance(i) == 2 ? at_dark : at_bright).add(static_cast<double>(made.batch.targets[3 * i]));
  ASSERT_GT(at_dark.count(), 100u);
  ASSERT_GT(at_bright.count(), 100u);
  // The lamp does not reach the dark wall, which a path of two events cannot learn from the bright one.
  EXPECT_EQ(at_dark.mean(), 0.0);
  EXPECT_GT(at_bright.mean(), 1.0);
}

}  // namespace
}  // namespace gatelight::renderer
