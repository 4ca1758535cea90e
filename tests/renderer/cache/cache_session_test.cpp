// Training of a cache: its counts and when it stops.

#include "renderer/cache/cache_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/errors.h"
#include "tests/renderer/cache/cache_sessions.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

/// A room of two materials with a lamp, a mirror and a glossy ball: everything that a batch may meet.
SceneBuilder room() {
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color(0.7f, 0.6f, 0.5f))), Vec3(-2, 0, -2),
              Vec3(2, 3, 2), true);
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color(9.0f, 8.0f, 7.0f))),
               Vec3(-0.5f, 2.9f, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1));
  builder.quad(builder.material(testing::mirror()), Vec3(-1.8f, 0.2f, -1.9f), Vec3(1.7f, 0, 0),
               Vec3(0, 2.5f, 0));
  scene::Material metal;
  metal.base_color = Color(0.9f, 0.7f, 0.4f);
  metal.roughness = 0.4f;
  builder.sphere(builder.material(metal), Vec3(0.8f, 0.6f, 0), 0.6f, 16, true);
  builder.scene().cameras.push_back(view_from(Vec3(0, 1.2f, 1.8f), Vec3(0, 1, -1)));
  return builder;
}

TEST(CacheSession, ItStopsOnRequestOrOutOfTime) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 1.0f));
  RenderOptions options = small_session(Integrator::nrc);
  CacheSession session(viewed.world, viewed.camera, viewed.region, options);
  std::vector<int> reported;
  std::vector<std::uint64_t> exported;
  CacheSession::Watch watch;
  watch.progress = [&](int done, int steps, double loss) {
    reported.push_back(done);
    EXPECT_EQ(steps, 100);
    EXPECT_TRUE(std::isfinite(loss));
  };
  watch.after_group = [&] { exported.push_back(session.export_state().steps); };
  watch.stop = [&] { return session.steps() >= 70; };
  session.train(100, watch);
  // Groups grow to 65536 records: 32 batches of 2048.
  EXPECT_EQ(reported, (std::vector<int>{1, 2, 4, 8, 16, 32, 64, 96}));
  EXPECT_EQ(exported, std::vector<std::uint64_t>(reported.begin(), reported.end()));
  options.cache.train_seconds = 1e-9;
  watch.stop = {};
  session.train(100, watch);
  EXPECT_EQ(session.steps(), 100u) << "no time: one group all the same, which ends where training does";
  session.train(100, watch);
  EXPECT_EQ(session.steps(), 100u) << "nothing left to do";
}

/// Makes all answers of the model this number, before the scale: the network's last layer has only its bias.
void answer_always(CacheSession& session, float value) {
  CacheState state = session.export_state();
  const neural::LayerLayout& last = session.model().parameters.layers.back();
  for (std::vector<float>* p : {&state.model.parameters, &state.model.averages}) {
    std::fill_n(p->begin() + static_cast<std::ptrdiff_t>(last.weights), last.inputs * last.outputs, 0.0f);
    std::fill_n(p->begin() + static_cast<std::ptrdiff_t>(last.biases), last.outputs, value);
  }
  session.import_state(state);
}

TEST(CacheSession, NegativeAnswersAreZeroAndCounted) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 8.0f));
  const RenderOptions options = small_session(Integrator::nrc);
  CacheSession session(viewed.world, viewed.camera, viewed.region, options);
  const SurfacePoints points = seen_points(viewed, session);
  answer_always(session, -0.5f);
  std::vector<float> answers(session.outputs() * points.size());
  EXPECT_EQ(session.answer(points, answers), points.size()) << "points, not channels";
  for (const float a : answers) ASSERT_EQ(a, 0.0f);
  answer_always(session, 0.5f);
  EXPECT_EQ(session.answer(points, answers), 0u);
  for (const float a : answers) ASSERT_FLOAT_EQ(a, 0.5f / session.setup().target_scale);
}

TEST(CacheSession, OverflowingAnswersAreFinite) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 8.0f));
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
    const RenderOptions options = small_session(integrator);
    CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    const SurfacePoints points = seen_points(viewed, session);
    const float most = integrator == Integrator::nrc ? std::numeric_limits<float>::max() : 1.0f;
    const auto expect_sound = [&] {
      for (const float a : answers_of(session, points)) ASSERT_TRUE(a >= 0.0f && a <= most) << a;
    };
    answer_always(session, 3e38f);  // overflows when it is scaled back
    expect_sound();
    EXPECT_EQ(answers_of(session, points)[0], most);
    // Infinities that meet within the network.
    CacheState state = session.export_state();
    for (std::size_t i = session.model().parameters.network; i < state.model.averages.size(); ++i)
      state.model.averages[i] = i % 3 == 0 ? -3e38f : 3e38f;
    session.import_state(state);
    expect_sound();
  }
}

TEST(CacheSession, SamplesOfAPointDoNotMultiplyTheWork) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 1.0f));
  RenderOptions options = small_session(Integrator::nrc);
  options.cache.path_length = 3;
  options.min_depth = 64;
  for (const int times : {1, 8}) {
    options.cache.samples_per_point = times;
    CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    session.train(3, {});
    const CacheStatistics s = session.statistics();
    EXPECT_NEAR(static_cast<double>(s.records), 3.0 * 2048.0, 0.03 * 3.0 * 2048.0);
    // Paths of a given length write a record at their first vertex only: one for eight paths. Some more paths
    // than needed are traced.
    const double paths_per_record = times;
    EXPECT_NEAR(static_cast<double>(s.training_paths) / static_cast<double>(s.records), paths_per_record,
                0.1 * paths_per_record);
  }
}

TEST(CacheSession, MirrorsAreCountedWherePathsBegin) {
  const ViewedWorld viewed(room());
  RenderOptions options = small_session(Integrator::nrc);
  options.max_depth = 4;
  options.cache.candidates = 16;
  CacheSession session(viewed.world, viewed.camera, viewed.region, options);
  session.train(12, {});
  const neural::GateSurface& mirror = session.model().gate.surfaces[neural::surface_index(2, 0)];
  ASSERT_EQ(mirror.triangle_count, 2u);
  for (std::uint32_t t = 0; t < 2; ++t)
    EXPECT_EQ(session.triangle_counts()[mirror.first_triangle + t], 12u) << "in each step, like the walls";
  const neural::GateSurface& walls = session.model().gate.surfaces[neural::surface_index(0, 0)];
  for (std::uint32_t t = 0; t < walls.triangle_count; ++t)
    EXPECT_EQ(session.triangle_counts()[walls.first_triangle + t], 12u);
}

TEST(CacheSession, TrianglesAreCountedOnlyWhereTheCountsAreUsed) {
  const ViewedWorld viewed(room());
  const auto counted = [&](int candidates, const std::vector<Aov>& aovs, neural::FeatureEncoding encoding) {
    RenderOptions options = small_session(Integrator::nrc);
    options.cache.candidates = candidates;
    options.cache.encoding = encoding;
    options.aovs = aovs;
    const CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    return !session.triangle_counts().empty();
  };
  EXPECT_FALSE(counted(1, {}, neural::FeatureEncoding::gate));
  EXPECT_TRUE(counted(16, {}, neural::FeatureEncoding::gate));
  EXPECT_TRUE(counted(1, {Aov::training_count}, neural::FeatureEncoding::gate));
  EXPECT_FALSE(counted(1, {}, neural::FeatureEncoding::hash_grid));
}

TEST(CacheSession, InvalidModelsAndDevicesAreRefused) {
  const ViewedWorld viewed(testing::closed_furnace(0.6f, 1.0f));
  RenderOptions options = small_session(Integrator::nrc);
  options.cache.mlp.width = 33;
  EXPECT_THROW(CacheSession(viewed.world, viewed.camera, viewed.region, options), BadConfiguration);
  options = small_session(Integrator::nrc);
  options.cache.device = "abacus";
  EXPECT_THROW(CacheSession(viewed.world, viewed.camera, viewed.region, options), Unavailable);
}

}  // namespace
}  // namespace gatelight::renderer
