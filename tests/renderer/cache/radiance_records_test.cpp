// Which vertices of training paths become records, and which of the records are kept.

#include "renderer/cache/radiance_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "tests/renderer/cache/made_records.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;
using testing::with_threads;

std::size_t queries_of(const RecordBatch& batch) {
  std::size_t sum = 0;
  for (const PathBatch& paths : batch.paths) sum += paths.queries.size();
  return sum;
}

/// A matte room with a lamp, and in it a mirror, a black block that shines and a pane.
SceneBuilder room() {
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color(0.7f, 0.6f, 0.5f))), Vec3(-2, 0, -2),
              Vec3(2, 3, 2), true);
  builder.quad(builder.material(testing::mirror()), Vec3(-1.5f, 0.2f, -1.5f), Vec3(1.4f, 0, 0),
               Vec3(0, 2, 0));
  builder.box(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(6.0f))),
              Vec3(0.2f, 0.4f, -1.5f), Vec3(1.2f, 1.4f, -0.8f));
  scene::Material pane = SceneBuilder::clear_glass();
  builder.quad(builder.material(pane), Vec3(-0.5f, 0.3f, -0.4f), Vec3(0.8f, 0, 0), Vec3(0, 1, 0));
  builder.scene().cameras.push_back(view_from(Vec3(0, 1.2f, 1.8f), Vec3(0, 1, -1)));
  return builder;
}

TEST(RadianceRecords, DeltaAndBlackVerticesWriteNoRecords) {
  const ViewedWorld viewed(room());
  const RenderOptions options;
  const MadeRecords made(viewed, options, {.step = 1, .points = 2000});
  ASSERT_GT(made.batch.records.size(), 2000u);
  std::map<std::uint32_t, int> met;
  for (std::size_t i = 0; i < made.batch.records.size(); ++i) ++met[made.instance(i)];
  EXPECT_EQ(met.size(), 1u) << "only the room";
  EXPECT_EQ(met.begin()->first, 0u);
  // Paths that begin at mirror, block or pane still leave records behind them.
  std::size_t beyond = 0;
  for (const PathBatch& paths : made.batch.paths) {
    for (std::size_t p = 0; p < paths.first_records.size(); ++p) {
      if (paths.first_records[p] == kNone) continue;
      const Eigen::Map<const Vec3> at(
          paths.records.batch().positions[static_cast<std::size_t>(paths.first_records[p])].data());
      beyond += at.z() > 1.85f ? 1 : 0;  // behind the camera: visible only in the mirror
    }
  }
  EXPECT_GT(beyond, 20u);
}

TEST(RadianceRecords, ExcessRecordsAreLeftOutEvenly) {
  const ViewedWorld viewed(room());
  const RenderOptions options;
  const MadeRecords all(viewed, options, {.step = 1, .points = 1000});
  const std::size_t n = all.batch.records.size();
  for (const std::size_t most : {std::size_t{1}, std::size_t{777}, n / 2, n - 1, n, n + 1}) {
    const MadeRecords some(viewed, options, {.step = 1, .points = 1000, .most_records = most});
    ASSERT_EQ(some.batch.records.size(), std::min(most, n));
    ASSERT_EQ(some.batch.targets.size(), 3 * some.batch.records.size());
    // Each record is one of all, in their order, with its own target; the gaps are as equal as possible.
    std::size_t at = 0;
    std::size_t last = 0;
    std::set<std::size_t> gaps;
    for (std::size_t i = 0; i < some.batch.records.size(); ++i) {
      while (at < n && !(all.batch.records.barycentrics(at) == some.batch.records.barycentrics(i) &&
                         all.batch.records.triangle(at) == some.batch.records.triangle(i)))
        ++at;
      ASSERT_LT(at, n);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(some.batch.targets[3 * i + c], all.batch.targets[3 * at + c]);
      if (i > 0) gaps.insert(at - last);
      last = at++;
    }
    EXPECT_GT((last + 1) * most, n * (most - 1)) << "up to the end";
    EXPECT_LE(gaps.size(), 2u);
    if (gaps.size() == 2) {
      EXPECT_EQ(*gaps.rbegin() - *gaps.begin(), 1u);
    }
  }
}

TEST(RadianceRecords, BatchesShareTheRecordsInTurn) {
  const ViewedWorld viewed(room());
  const RenderOptions options;
  const MadeRecords all(viewed, options, {.step = 1, .points = 1000});
  const std::size_t n = all.batch.records.size();
  for (const std::size_t most : {std::size_t{2}, std::size_t{301}, n, 2 * n}) {
    const MadeRecords made(viewed, options, {.step = 1, .points = 1000, .most_records = most, .batches = 3});
    const MadeRecords one(viewed, options, {.step = 1, .points = 1000, .most_records = most});
    ASSERT_EQ(made.batch.records.size(), std::min(most, n));
    std::size_t seen = 0;
    for (std::size_t m = 0; m < 3; ++m) {
      const neural::TrainingBatch batch = made.batch.batch(m);
      ASSERT_EQ(batch.points.size, (std::min(most, n) + 2 - m) / 3);
      ASSERT_EQ(batch.targets.size(), 3 * batch.points.size);
      ASSERT_EQ(batch.points.triangles.size(), batch.points.size);
      for (std::size_t i = 0; i < batch.points.size; ++i, ++seen) {
        ASSERT_EQ(batch.points.barycentrics[i], one.batch.records.barycentrics(3 * i + m));
        ASSERT_EQ(batch.points.positions[i], one.batch.records.batch().positions[3 * i + m]);
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_EQ(batch.targets[3 * i + c], one.batch.targets[3 * (3 * i + m) + c]);
      }
    }
    EXPECT_EQ(seen, made.batch.records.size());
  }
}

TEST(RadianceRecords, ShortPathsEndAfterTheirRecordsAndSomeRunOn) {
  const ViewedWorld viewed(testing::closed_furnace(0.5f, 1.0f));
  RenderOptions options;
  options.min_depth = 64;
  constexpr std::size_t kUnroulettedEvents = 64;  // then the throughput is 2^-64
  const AnswerPoints zero{
      [](const SurfacePoints&, std::span<float> a) { std::fill(a.begin(), a.end(), 0.0f); }};
  for (const int vertices : {1, 2, 3}) {
    options.cache.self_training.vertices = vertices;
    for (const float fraction : {0.0f, 0.25f, 1.0f}) {
      options.cache.self_training.full_fraction = fraction;
      const MadeRecords made(viewed, options, {.step = 1, .points = 400, .self_training = true}, zero);
      const auto paths = static_cast<double>(made.batch.paths_traced);
      std::size_t full = 0;
      for (const PathStart& s : made.batch.starts.starts) full += s.to_its_end ? 1 : 0;
      EXPECT_EQ(queries_of(made.batch), made.batch.starts.starts.size() - full);
      EXPECT_NEAR(static_cast<double>(full), static_cast<double>(fraction) * paths, 1.0);
      const auto short_records = static_cast<std::size_t>(vertices) * queries_of(made.batch);
      EXPECT_EQ(made.batch.records.size(), short_records + kUnroulettedEvents * full);
    }
  }
}

TEST(RadianceRecords, SamplesOfAPointBecomeOneRecordAtThePoint) {
  const ViewedWorld viewed(testing::closed_furnace(0.5f, 1.0f));
  RenderOptions options;
  options.cache.path_length = 2;
  options.min_depth = 64;
  for (const int times : {1, 8}) {
    options.cache.samples_per_point = times;
    const MadeRecords made(viewed, options, {.step = 1, .points = 192});
    const auto all_paths = 192 * static_cast<std::size_t>(times);
    EXPECT_EQ(made.batch.paths_traced, all_paths);
    EXPECT_EQ(made.batch.records.size(), 192u);
    std::set<neural::Float2> places;
    for (std::size_t i = 0; i < made.batch.records.size(); ++i)
      places.insert(made.batch.records.barycentrics(i));
    EXPECT_EQ(places.size(), made.batch.records.size()) << "no point twice";
  }
}

TEST(RadianceRecords, AnyNumberOfThreadsGivesTheSameBits) {
  const ViewedWorld viewed(room());
  RenderOptions options;
  options.cache.samples_per_point = 2;
  const auto ask = [](const SurfacePoints& points, std::span<float> a) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) a[3 * i + c] = points.barycentrics(i)[0];
    }
  };
  const RecordRequest request{.step = 5, .points = 12000, .most_records = 18000, .self_training = true};
  // By all blocks at once, as for a device, and by each thread for its blocks.
  std::vector<float> targets[4];
  std::vector<neural::Float2> places[4];
  const int threads[] = {1, 2, 7, 7};
  for (std::size_t i = 0; i < 4; ++i) {
    with_threads(threads[i], [&] {
      const MadeRecords made(viewed, options, request, {ask, i % 2 == 1});
      targets[i] = made.batch.targets;
      const std::span<const neural::Float2> where = made.batch.records.batch().barycentrics;
      places[i].assign(where.begin(), where.end());
    });
  }
  ASSERT_EQ(targets[0].size(), 3u * 18000u);
  for (const std::size_t i : {1u, 2u, 3u}) {
    EXPECT_EQ(targets[0], targets[i]);
    EXPECT_EQ(places[0], places[i]);
  }
}

}  // namespace
}  // namespace gatelight::renderer
