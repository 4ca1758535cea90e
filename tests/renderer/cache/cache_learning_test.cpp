// What a session learns in closed forms: the mean of its answers differs by a measured bias.

#include "renderer/cache/cache_session.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "tests/renderer/cache/cache_sessions.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"

namespace gatelight::renderer {
namespace {

using testing::MeasuredError;
using testing::MeasuredErrors;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

// Of the means of this file, and of those that are tested together.
const double kLearningSignificance = testing::sidak(1e-4, 9);

struct Learned {
  CachedComponent holds;
  neural::FeatureEncoding encoding;
  MeasuredError error;
};

// Errors of the mean answer, measured with the seeds 1 to 32.
constexpr Learned kLearned[] = {
    {CachedComponent::all, neural::FeatureEncoding::gate, {-0.0015, 0.0122, 32}},
    {CachedComponent::no_delta, neural::FeatureEncoding::gate, {-0.0015, 0.0122, 32}},
    {CachedComponent::indirect, neural::FeatureEncoding::gate, {-0.0034, 0.0175, 32}},
    {CachedComponent::no_delta, neural::FeatureEncoding::hash_grid, {-0.0013, 0.0123, 32}}};
constexpr std::pair<TrainingSource, MeasuredError> kSources[] = {
    {TrainingSource::camera, {-0.0009, 0.0107, 32}}, {TrainingSource::surface, {-0.0023, 0.0108, 32}}};
constexpr MeasuredError kAttenuatedError = {-0.0018, 0.0039, 32};

RenderOptions options_of(const Learned& learned, std::uint32_t seed) {
  RenderOptions options = small_session(Integrator::nrc);
  options.seed = seed;
  options.cache.component = learned.holds;
  options.cache.encoding = learned.encoding;
  options.cache.hash_grid.levels = 4;
  options.cache.hash_grid.log2_table_size = 12;
  return options;
}

/// The light that is stored of a furnace with an emission of 30.
double stored_light(const Learned& learned) {
  const double sent = 30.0 / (1.0 - 0.6);
  return learned.holds == CachedComponent::indirect ? sent - 30.0 : sent;
}

TEST(CacheLearning, AClosedFurnaceSendsEmissionOverOneMinusAlbedo) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 30.0f));
  MeasuredErrors errors;
  std::uint32_t seed = 100;
  for (const Learned& learned : kLearned) {
    SCOPED_TRACE(seed);
    const RenderOptions options = options_of(learned, seed++);  // the session refers to them
    CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    session.train(100, {});
    EXPECT_EQ(session.steps(), 100u);
    const double mean = mean_answer(session, viewed);
    EXPECT_GT(errors.p_value(mean, stored_light(learned), learned.error), kLearningSignificance) << mean;

    const CacheStatistics s = session.statistics();
    EXPECT_EQ(s.steps, 100);
    EXPECT_EQ(s.rejected, 0u);
    EXPECT_EQ(s.unstored, 0u);
    EXPECT_EQ(s.negative_answers, 0u);
    EXPECT_NEAR(static_cast<double>(s.records), 100.0 * 2048.0, 0.05 * 100.0 * 2048.0);
    EXPECT_LE(s.records, 100u * 2048u);
    EXPECT_GT(s.nodes, 0u);
    EXPECT_EQ(s.nodes, session.model().parameters.node_count);
    EXPECT_FALSE(s.backend.empty());
  }
  EXPECT_GT(errors.common_p_value(), kLearningSignificance);
}

double answer_of_source(TrainingSource source, std::uint32_t seed) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 2.0f));
  RenderOptions options = small_session(Integrator::nrc);
  options.seed = seed;
  options.cache.source = source;
  options.cache.samples_per_point = 4;
  options.cache.candidates = 4;
  options.cache.bf16_queries = true;
  CacheSession session(viewed.world, viewed.camera, viewed.region, options);
  session.train(80, {});
  return mean_answer(session, viewed);
}

TEST(CacheLearning, PointsOfEverySourceLearnTheSameFurnace) {
  MeasuredErrors errors;
  std::uint32_t seed = 100;
  for (const auto& [source, error] : kSources) {
    const double mean = answer_of_source(source, seed++);
    EXPECT_GT(errors.p_value(mean, 5.0, error), kLearningSignificance) << mean;
  }
  EXPECT_GT(errors.common_p_value(), kLearningSignificance);
}

double attenuated_answer(std::uint32_t seed) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 1.0f));
  RenderOptions options = small_session(Integrator::nrc);
  options.seed = seed;
  options.cache.component = CachedComponent::all;
  options.cache.self_training.start_step = 0;
  options.cache.self_training.vertices = 1;
  options.cache.self_training.full_fraction = 0.0f;
  options.cache.self_training.attenuation = 0.5f;
  CacheSession session(viewed.world, viewed.camera, viewed.region, options);
  session.train(120, {});
  return mean_answer(session, viewed);
}

TEST(CacheLearning, AnAttenuatedCacheLearnsTooLittle) {
  const double answer = attenuated_answer(0);
  // The fixed point of y = Le + a / 2 y.
  EXPECT_GT(MeasuredErrors().p_value(answer, 1.0 / 0.7, kAttenuatedError), kLearningSignificance) << answer;
}

TEST(CacheLearning, OcclusionIsLearnedAndStaysWithinOne) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 9);
  builder.scene().cameras.push_back(view_from(Vec3(0, 2, 0), Vec3(0, 0, 0)));
  const ViewedWorld viewed(builder);
  const RenderOptions options = small_session(Integrator::nao);
  CacheSession session(viewed.world, viewed.camera, viewed.region, options);
  EXPECT_EQ(session.outputs(), 1u);
  session.train(30, {});
  for (const float a : answers_of(session, seen_points(viewed, session))) {
    ASSERT_LE(a, 1.0f);
    ASSERT_GT(a, 0.95f);
  }
}

}  // namespace
}  // namespace gatelight::renderer
