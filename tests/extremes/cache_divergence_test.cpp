// The cache: diverging training is detected, and the last good state is kept.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "renderer/render.h"
#include "tests/extremes/extreme.h"
#include "tests/support/messages.h"
#include "tests/support/room.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using testing::report_extreme;
using testing::room;
using tests::read_file;
using tests::TemporaryFolder;

RenderOptions small(float rate, int steps) {
  RenderOptions options = testing::small_picture();
  options.integrator = Integrator::nrc;
  options.aovs.clear();
  options.spp = 2;
  options.cache.query_at = QueryAt::primary;
  options.cache.batch = 1024;
  options.cache.train_steps = steps;
  options.cache.training.adam.learning_rate = rate;
  return options;
}

struct Outcome {
  Picture picture;
  RenderStatistics statistics;
  std::string diverged;  ///< message of the exception, or empty
};

Outcome run(const scene::Scene& scene, const RenderOptions& options, const Callbacks& callbacks = {}) {
  Outcome outcome;
  Renderer renderer(scene, options);
  try {
    outcome.picture = renderer.render(callbacks);
  } catch (const TrainingDiverged& error) {
    outcome.diverged = error.what();
  }
  outcome.statistics = renderer.statistics();
  return outcome;
}

bool finite(const Picture& picture) {
  for (const float value : picture.layers[0].values)
    if (!std::isfinite(value) || value < 0.0f) return false;
  return !picture.layers[0].values.empty();
}

double mean(const Picture& picture) {
  double sum = 0.0;
  for (const float value : picture.layers[0].values) sum += static_cast<double>(value);
  return sum / static_cast<double>(picture.layers[0].values.size());
}

TEST(CacheDivergence, UsefulLearningRatesAreNotReportedAsDivergence) {
  const scene::Scene s = room();
  const double usual = mean(run(s, small(1e-2f, 300)).picture);
  double least = 10.0, greatest = 0.0;
  for (const float rate : {0.0f, 1e-8f, 1e-3f, 0.05f})
    for (const neural::Loss loss : {neural::Loss::l2, neural::Loss::relative_l2}) {
      RenderOptions options = small(rate, 300);
      options.cache.training.loss = loss;
      const Outcome outcome = run(s, options);
      EXPECT_EQ(outcome.diverged, "") << rate;
      EXPECT_EQ(outcome.statistics.cache.diverged, "") << rate;
      EXPECT_TRUE(finite(outcome.picture)) << rate;
      least = std::min(least, mean(outcome.picture) / usual);
      greatest = std::max(greatest, mean(outcome.picture) / usual);
    }
  EXPECT_GE(least, 0.5);
  EXPECT_LE(greatest, 2.0);
  report_extreme(
      "learning rates 0, 1e-8, 1e-3, 0.05", "a room, 300 steps of 1024 records, l2 and relative loss",
      fmt::format("no alarm; pictures are {:.2f} to {:.2f} times as bright as with 0.01 (bounds 0.5, 2)",
                  least, greatest),
      "");
}

TEST(CacheDivergence, LargeRatesAreDetectedAndNoFileIsOverwritten) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  const auto file = folder.write("cache.safetensors", "an older cache");
  std::string reported;
  for (const float rate : {1e2f, 1e3f, 1e6f})
    for (const neural::Loss loss : {neural::Loss::l2, neural::Loss::relative_l2}) {
      SCOPED_TRACE(rate);
      RenderOptions options = small(rate, 64);
      options.cache.training.loss = loss;
      options.cache.cache_out = file.string();
      const Outcome outcome = run(s, options);
      tests::expect_message(outcome.diverged, {"training step"});
      if (rate == 1e3f) reported = outcome.diverged;
      EXPECT_EQ(read_file(file), "an older cache");
      EXPECT_EQ(folder.count_files(), 1u);
    }
  report_extreme("learning rates 1e2, 1e3, 1e6", "a room, new caches, l2 and relative loss",
                 "the file of --cache-out stays as it was, no part of a new one is left",
                 fmt::format("within 64 steps, exit code 6: \"{}\"", reported));
}

// Training that starts from a cache file: the loaded cache is the last good state.
TEST(CacheDivergence, ALoadedCacheIsKeptWhenMoreTrainingDiverges) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  const std::string good = (folder / "good.safetensors").string();
  const std::string out = (folder / "out.safetensors").string();
  RenderOptions options = small(1e-2f, 100);
  options.cache.cache_out = good;
  ASSERT_EQ(run(s, options).diverged, "");

  options = small(1e-2f, 0);
  options.cache.cache_in = good;
  const Outcome expected = run(s, options);
  options = small(1e3f, 64);
  options.cache.cache_in = good;
  options.cache.cache_out = out;
  const Outcome outcome = run(s, options);
  EXPECT_EQ(outcome.diverged, "");
  tests::expect_message(outcome.statistics.cache.diverged, {"training step"});
  EXPECT_EQ(outcome.statistics.cache.steps, 0);
  EXPECT_TRUE(outcome.picture.layers[0].values == expected.picture.layers[0].values);
  // And the file written renders the same.
  options = small(1e-2f, 0);
  options.cache.cache_in = out;
  EXPECT_TRUE(run(s, options).picture.layers[0].values == expected.picture.layers[0].values);
  report_extreme("a good cache trained further with a rate of 1e3", "--cache-in, --cache-out, 64 steps more",
                 "picture and cache file have the bits of the cache that was loaded",
                 "exit code 6 once all is written");
}

/// Options of a training that diverges after 512 steps: answers come back threefold as targets.
RenderOptions late() {
  RenderOptions options = small(1e-2f, 2048);
  options.cache.training.loss = neural::Loss::l2;
  options.cache.self_training.start_step = 512;
  options.cache.self_training.attenuation = 3.0f;
  return options;
}

// Late divergence restores the state of the last good step, with the bits of a training that ended there.
TEST(CacheDivergence, LateDivergenceRestoresTheLastGoodStep) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  RenderOptions options = late();
  options.cache.cache_out = (folder / "kept.safetensors").string();
  const Outcome outcome = run(s, options);
  const int kept = outcome.statistics.cache.steps;
  EXPECT_EQ(outcome.diverged, "");
  tests::expect_message(outcome.statistics.cache.diverged, {"loss"});
  EXPECT_GE(kept, 256);
  EXPECT_LE(kept, 640);

  options.cache.train_steps = kept;
  options.cache.cache_out = (folder / "expected.safetensors").string();
  options.threads = 1;
  const Outcome expected = run(s, options);
  EXPECT_EQ(expected.statistics.cache.diverged, "");
  EXPECT_TRUE(outcome.picture.layers[0].values == expected.picture.layers[0].values);
  EXPECT_TRUE(read_file(folder / "kept.safetensors") == read_file(folder / "expected.safetensors"));
  EXPECT_EQ(outcome.statistics.cache.records, expected.statistics.cache.records);
  report_extreme("training that diverges after 512 steps", "answers come back threefold as targets",
                 fmt::format("picture and cache file have the bits of a training of {} steps", kept),
                 fmt::format("exit code 6 once all is written: \"{}\"", outcome.statistics.cache.diverged));
}

// A checkpoint written after the divergence and before its detection is not a good state.
TEST(CacheDivergence, ResumingFromABadCheckpointEqualsAnUninterruptedRun) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  const Outcome expected = run(s, late());
  const int kept = expected.statistics.cache.steps;

  RenderOptions options = late();
  options.checkpoint.file = (folder / "checkpoint").string();
  Callbacks callbacks;
  callbacks.stop = [calls = 0]() mutable { return ++calls > 20; };  // between groups of 64 steps
  const int stopped = run(s, options, callbacks).statistics.cache.steps;
  EXPECT_GT(stopped, kept);
  options.checkpoint.resume = true;
  const Outcome outcome = run(s, options);
  EXPECT_NE(outcome.statistics.cache.diverged, "");
  EXPECT_EQ(outcome.statistics.cache.diverged, expected.statistics.cache.diverged);
  EXPECT_EQ(outcome.statistics.cache.steps, kept);
  EXPECT_EQ(outcome.statistics.cache.records, expected.statistics.cache.records);
  EXPECT_TRUE(outcome.picture.layers[0].values == expected.picture.layers[0].values);
  report_extreme(
      "the same, stopped between the divergence and its detection, then resumed",
      fmt::format("a checkpoint of step {}", stopped),
      fmt::format("detected at the same step; picture and statistics have the bits of step {}", kept),
      "exit code 6 once all is written");
}

}  // namespace
}  // namespace gatelight::renderer
