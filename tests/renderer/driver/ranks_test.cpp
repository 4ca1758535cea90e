// One picture by several ranks has the bits of one process.

#include <gtest/gtest.h>

#include <atomic>

#include "renderer/render.h"
#include "tests/renderer/image/kinds_of_pictures.h"
#include "tests/support/room.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thread_ranks.h"

namespace gatelight::renderer {
namespace {

using kinds::expect_same;
using kinds::kKinds;
using kinds::picture_of;
using kinds::Result;
using kinds::result_of;
using testing::room;
using tests::read_file;
using tests::run_ranks;
using tests::TemporaryFolder;

/// Rank 0's result. The ranks have 1, 2, 1, 2, ... threads. Stops at the n-th call of the stop callbacks,
/// counted over all ranks.
Result render_by(int count, const scene::Scene& scene, const RenderOptions& options, int stop_at = 0) {
  Result result;
  std::atomic<int> calls{0};
  run_ranks(count, [&](Ranks& ranks) {
    RenderOptions own = options;
    own.threads = 1 + ranks.rank() % 2;
    own.ranks = &ranks;
    Renderer renderer(scene, own);
    Callbacks callbacks;
    callbacks.stop = [&] { return ++calls == stop_at; };
    Picture picture = renderer.render(callbacks);
    if (!ranks.first()) {
      EXPECT_TRUE(picture.layers.empty());
    } else {
      result = {std::move(picture), renderer.statistics()};
    }
  });
  return result;
}

using RanksOfPictures = kinds::Kinds;

TEST_P(RanksOfPictures, GiveTheBitsOfOneProcess) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(GetParam().integrator);
  GetParam().change(options);
  options.width = 70;
  options.height = 100;
  if (options.region) options.region = {{3, 2, 60, 91}};
  const Result alone = result_of(s, options);
  for (const int count : {2, 3, 5}) {
    SCOPED_TRACE(count);
    const Result together = render_by(count, s, options);
    expect_same(together, alone);
    EXPECT_EQ(together.statistics.estimated_error, alone.statistics.estimated_error);
    ASSERT_EQ(together.statistics.team.size(), static_cast<std::size_t>(count));
    std::uint64_t samples = 0, paths = 0;
    for (const ProcessStatistics& rank : together.statistics.team) {
      samples += rank.samples;
      paths += rank.training_paths;
    }
    EXPECT_EQ(samples, alone.statistics.samples);
    EXPECT_EQ(paths, alone.statistics.cache.training_paths);
  }
}

TEST_P(RanksOfPictures, ResumePicturesOfAnyNumberOfRanks) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(GetParam().integrator);
  GetParam().change(options);
  const Result straight = result_of(s, options);
  for (const int first_stop : {1, 3, 8}) {
    const TemporaryFolder folder;
    options.checkpoint.file = folder / "picture";
    options.checkpoint.resume = true;
    options.checkpoint.every_seconds = first_stop == 3 ? 60.0 : 0.0;
    Result result;
    int runs = 0;
    for (int stop = first_stop; runs < 20; ++runs, stop = 2 * stop + 1) {
      result = render_by(1 + (runs + 1) % 3, s, options, stop);
      EXPECT_EQ(folder.count_files(), 1u);
      if (!result.statistics.interrupted) break;
    }
    EXPECT_GT(runs, 0) << "it was never stopped";
    EXPECT_LT(runs, 20);
    expect_same(result, straight);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, RanksOfPictures, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Ranks, WriteTheCacheFileOfOneProcess) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(Integrator::nrc);
  options.cache.candidates = 1;
  const TemporaryFolder folder;
  options.cache.cache_out = folder / "alone";
  Renderer(s, options).render();
  options.cache.cache_out = folder / "together";
  render_by(3, s, options);
  EXPECT_EQ(read_file(folder / "together"), read_file(folder / "alone"));
}

TEST(Ranks, AgreeOnTheErrorAtWhichAPictureEnds) {
  const scene::Scene s = room();
  GATELIGHT_NEEDS_DENOISER();
  for (const bool denoised : {false, true}) {
    RenderOptions options = picture_of(Integrator::path);
    if (denoised) testing::denoise(options);
    options.max_error = 0.2;
    options.spp = 200;
    const Result alone = result_of(s, options);
    EXPECT_EQ(alone.statistics.ended_by, EndedBy::max_error);
    const Result together = render_by(3, s, options);
    EXPECT_EQ(together.statistics.ended_by, EndedBy::max_error);
    expect_same(together, alone);
  }
}

TEST(Ranks, WriteAlphaAndCryptomattesOfOneProcess) {
  GATELIGHT_NEEDS_DENOISER();
  const scene::Scene s = room();
  RenderOptions options = picture_of(Integrator::path);
  options.height = 100;
  testing::denoise(options);
  options.background.kind = BackgroundOptions::Kind::transparent;
  options.cryptomattes = {MatteKind::object};
  const Result alone = result_of(s, options);
  const Result together = render_by(3, s, options);
  ASSERT_EQ(alone.picture.layers.size(), together.picture.layers.size());
  for (std::size_t i = 0; i < alone.picture.layers.size(); ++i)
    EXPECT_TRUE(alone.picture.layers[i].values == together.picture.layers[i].values) << i;
}

TEST(Ranks, MayBeMoreThanTilesAndRows) {
  GATELIGHT_NEEDS_DENOISER();
  const scene::Scene s = room();
  RenderOptions options = picture_of(Integrator::path);
  testing::denoise(options);
  const Result alone = result_of(s, options);
  expect_same(render_by(9, s, options), alone);
}

TEST(Ranks, ReturnToTheSameGoodStateAfterDivergence) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(Integrator::nrc);
  options.cache.candidates = 1;
  options.cache.train_steps = 64;
  options.cache.training.adam.learning_rate = 30.0f;
  std::string expected, reported;
  Result alone;
  try {
    alone = result_of(s, options);
    expected = alone.statistics.cache.diverged;
  } catch (const TrainingDiverged& error) {
    expected = error.what();
  }
  EXPECT_NE(expected, "");
  try {
    const Result together = render_by(2, s, options);
    reported = together.statistics.cache.diverged;
    expect_same(together, alone);
  } catch (const TrainingDiverged& error) {
    reported = error.what();
  }
  EXPECT_EQ(reported, expected);
}

TEST(Ranks, EndByATimeLimitTogether) {
  GATELIGHT_NEEDS_DENOISER();
  const scene::Scene s = room();
  for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
    RenderOptions options = picture_of(integrator);
    options.spp = 1000000;
    testing::denoise(options);
    options.aovs.clear();
    options.cache.train_steps = 100000;
    options.cache.candidates = 1;
    options.time_limit_seconds = 1.0;
    const Result result = render_by(3, s, options);
    EXPECT_EQ(result.statistics.ended_by, EndedBy::time_limit);
    EXPECT_GE(result.statistics.spp, 1);
    EXPECT_FALSE(result.picture.layers.empty());
  }
}

TEST(Ranks, RefuseSeries) {
  const scene::Scene s = room();
  run_ranks(2, [&](Ranks& ranks) {
    RenderOptions options = picture_of(Integrator::path);
    options.ranks = &ranks;
    Renderer renderer(s, options);
    EXPECT_THROW(renderer.render_series({.spp = {1}}, {}), BadOption);
  });
}

}  // namespace
}  // namespace gatelight::renderer
