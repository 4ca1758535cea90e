// The cache: diverging training is detected, and the last good state is kept.

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.h"
#include "renderer/render.h"
#include "tests/support/messages.h"
#include "tests/support/room.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

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
  for (const float rate : {0.0f, 1e-8f, 1e-3f, 0.05f})
    for (const neural::Loss loss : {neural::Loss::l2, neural::Loss::relative_l2}) {
      RenderOptions options = small(rate, 300);
      options.cache.training.loss = loss;
      const Outcome outcome = run(s, options);
      EXPECT_EQ(outcome.diverged, "") << rate;
      EXPECT_EQ(outcome.statistics.cache.diverged, "") << rate;
      EXPECT_TRUE(finite(outcome.picture)) << rate;
      EXPECT_GE(mean(outcome.picture), 0.5 * usual) << rate;
      EXPECT_LE(mean(outcome.picture), 2.0 * usual) << rate;
    }
}

TEST(CacheDivergence, LargeRatesAreDetectedAndNoFileIsOverwritten) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  const auto file = folder.write("cache.safetensors", "an older cache");
  for (const float rate : {1e2f, 1e3f, 1e6f})
    for (const neural::Loss loss : {neural::Loss::l2, neural::Loss::relative_l2}) {
      SCOPED_TRACE(rate);
      RenderOptions options = small(rate, 64);
      options.cache.training.loss = loss;
      options.cache.cache_out = file.string();
      const Outcome outcome = run(s, options);
      tests::expect_message(outcome.diverged, {"training step"});
      EXPECT_EQ(read_file(file), "an older cache");
      EXPECT_EQ(folder.count_files(), 1u);
    }
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
}

}  // namespace
}  // namespace gatelight::renderer
