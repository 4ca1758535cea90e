// Pictures with a cache of a closed furnace have the radiance of its closed form, but for a measured bias.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "renderer/render.h"
#include "tests/renderer/cache/cached_pictures.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::MeasuredError;
using testing::MeasuredErrors;
using testing::moments_of;
using testing::SceneBuilder;
using testing::ViewedWorld;

// Of the means of this file, and of those that are tested together.
const double kFurnaceSignificance = testing::sidak(1e-4, 15);

struct Setting {
  CachedComponent holds;
  QueryAt query_at;
  MeasuredError error;
};

// Errors of the mean radiance, measured with the seeds 1 to 32.
constexpr Setting kSettings[] = {{CachedComponent::all, QueryAt::primary, {0.0010, 0.0055, 32}},
                                 {CachedComponent::all, QueryAt::gather, {0.0006, 0.0036, 32}},
                                 {CachedComponent::all, QueryAt::spread, {0.0006, 0.0037, 32}},
                                 {CachedComponent::all, QueryAt::none, {0.0001, 0.0047, 32}},
                                 {CachedComponent::no_delta, QueryAt::primary, {0.0010, 0.0055, 32}},
                                 {CachedComponent::no_delta, QueryAt::gather, {0.0006, 0.0036, 32}},
                                 {CachedComponent::no_delta, QueryAt::spread, {0.0006, 0.0037, 32}},
                                 {CachedComponent::indirect, QueryAt::primary, {0.0009, 0.0042, 32}},
                                 {CachedComponent::indirect, QueryAt::gather, {0.0005, 0.0029, 32}},
                                 {CachedComponent::indirect, QueryAt::spread, {0.0005, 0.0029, 32}}};
constexpr MeasuredError kMixedError = {0.0001, 0.0050, 32};
constexpr MeasuredError kViewError = {0.0016, 0.0092, 32};

std::string name_of(const Setting& s) {
  const char* const holds[] = {"all", "no-delta", "indirect"};
  const char* const at[] = {"primary", "gather", "spread", "none"};
  return std::string(holds[static_cast<std::size_t>(s.holds)]) + ", " +
         at[static_cast<std::size_t>(s.query_at)];
}

/// A picture of the furnace, and what the cache counted.
Picture furnace(const Setting& setting, std::uint32_t seed, CacheStatistics& statistics) {
  SceneBuilder builder = testing::closed_furnace(0.6f, 2.0f);
  RenderOptions options = cached_picture(Integrator::nrc);
  options.seed = seed;
  options.cache.component = setting.holds;
  options.cache.query_at = setting.query_at;
  Renderer renderer(builder.scene(), options);
  const Picture picture = renderer.render();
  statistics = renderer.statistics().cache;
  return picture;
}

TEST(CachedFurnace, ShowsEmissionOverOneMinusAlbedo) {
  MeasuredErrors errors;
  std::uint32_t seed = 100;
  for (const Setting& setting : kSettings) {
    SCOPED_TRACE(name_of(setting));
    CacheStatistics s;
    const Picture picture = furnace(setting, seed++, s);
    expect_sound(picture);
    const double mean = moments_of(picture).mean();
    EXPECT_GT(errors.p_value(mean, 2.0 / (1.0 - 0.6), setting.error), kFurnaceSignificance) << mean;
    const double paths = setting.query_at == QueryAt::none ? 0.0 : 64.0 * 48.0 * 4.0;
    // One query a path, except for paths that roulette ends before they have spread.
    EXPECT_NEAR(static_cast<double>(s.queries), paths, setting.query_at == QueryAt::spread ? 100.0 : 0.0);
    EXPECT_EQ(s.unstored_hits, 0u);
    EXPECT_EQ(s.steps, 60);
  }
  EXPECT_GT(errors.common_p_value(), kFurnaceSignificance);
}

/// A furnace with a box of the same material that has no storage.
Picture mixed_furnace(std::uint32_t seed, CacheStatistics& statistics) {
  SceneBuilder builder = testing::closed_furnace(0.6f, 2.0f);
  builder.box(0, Vec3(-0.8f, -0.9f, -1.0f), Vec3(0.6f, 0.4f, 0.2f));
  const ViewedWorld viewed(builder);
  RenderOptions options = cached_picture(Integrator::nrc);
  options.seed = seed;
  options.cache.query_at = QueryAt::primary;
  CacheSetup setup;
  setup.sides = {neural::Sides::front, neural::Sides::none};
  setup.node_spacing = 0.7f;
  setup.target_scale = 0.2f;
  setup.records_per_path = 2.0f;
  setup.records_per_short_path = 2.0f;
  CacheSession session(viewed.world, viewed.camera, viewed.region, options, &setup);
  session.train(60, {});
  return pass_over(viewed, options, session, viewed.region, &statistics);
}

TEST(CachedFurnace, MayMixInstancesWithAndWithoutStorage) {
  CacheStatistics statistics;
  const double mean = moments_of(mixed_furnace(0, statistics)).mean();
  EXPECT_GT(statistics.queries, 3000u);
  EXPECT_GT(statistics.unstored_hits, 1000u);
  EXPECT_GT(MeasuredErrors().p_value(mean, 5.0, kMixedError), kFurnaceSignificance) << mean;
}

double mean_of_the_caches_view(QueryAt at, std::uint32_t seed) {
  SceneBuilder builder = testing::closed_furnace(0.6f, 2.0f);
  RenderOptions options = cached_picture(Integrator::nrc);
  options.seed = seed;
  options.cache.view = CacheOutput::cache;
  options.cache.query_at = at;
  return moments_of(Renderer(builder.scene(), options).render()).mean();
}

TEST(CachedFurnace, TheCachesViewIsTheLearnedLight) {
  // The view has neither the emission nor the reflectance of the visible surface.
  MeasuredErrors errors;
  std::uint32_t seed = 100;
  for (const QueryAt at : {QueryAt::primary, QueryAt::gather}) {
    const double mean = mean_of_the_caches_view(at, seed++);
    EXPECT_GT(errors.p_value(mean, 5.0, kViewError), kFurnaceSignificance) << mean;
  }
  EXPECT_GT(errors.common_p_value(), kFurnaceSignificance);
}

}  // namespace
}  // namespace gatelight::renderer
