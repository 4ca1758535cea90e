// Many pictures of one run.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include "base/clock.h"
#include "renderer/render.h"
#include "tests/renderer/image/kinds_of_pictures.h"
#include "tests/support/denoiser.h"
#include "tests/support/messages.h"
#include "tests/support/room.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using kinds::expect_same;
using kinds::kKinds;
using kinds::picture_of;
using kinds::Result;
using kinds::result_of;
using testing::room;
using tests::expect_parts;
using tests::TemporaryFolder;

/// A series of the kind of points that the integrator has.
Series series_of(Integrator integrator, const std::vector<int>& steps, const std::vector<int>& spp) {
  return uses_cache(integrator) ? Series{.train_steps = steps} : Series{.spp = spp};
}

std::vector<Result> collect(Renderer& renderer, const Series& series, const Callbacks& callbacks = {},
                            bool whole = true) {
  std::vector<Result> results;
  const bool answer = renderer.render_series(
      series,
      [&](int point, const Picture& picture, const RenderStatistics& statistics) {
        EXPECT_EQ(static_cast<std::size_t>(point), results.size());
        results.push_back({picture, statistics});
      },
      callbacks);
  EXPECT_EQ(answer, whole);
  return results;
}

/// The picture of one point by itself.
Result render_point(const scene::Scene& scene, RenderOptions options, const Series& series,
                    std::size_t point) {
  if (uses_cache(options.integrator)) {
    options.cache.train_steps = series.train_steps[point];
  } else {
    options.spp = series.spp[point];
  }
  return result_of(scene, options);
}

using SeriesOf = kinds::Kinds;

TEST_P(SeriesOf, EachPictureIsThatOfARunThatEndsThere) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(GetParam().integrator);
  GetParam().change(options);
  // Groups of steps end at 1, 2, 4, 8, 16.
  const Series series = series_of(options.integrator, {0, 3, 4, 7, 11, 16}, {1, 2, 5, 6, 9, 10});
  options.threads = 2;
  Renderer renderer(s, options);
  const std::vector<Result> results = collect(renderer, series);
  ASSERT_EQ(results.size(), 6u);
  options.threads = 1;
  for (std::size_t point = 0; point < 6; ++point) {
    SCOPED_TRACE(point);
    const Result alone = render_point(s, options, series, point);
    expect_same(results[point], alone);
    EXPECT_EQ(results[point].statistics.cache.loss, alone.statistics.cache.loss);
    EXPECT_FALSE(results[point].statistics.interrupted);
    EXPECT_FALSE(results[point].statistics.cache.steps_chosen);
    if (point > 0) {
      EXPECT_NE(results[point].picture.layers[0].values, results[point - 1].picture.layers[0].values);
    }
  }
  expect_same({results.back().picture, renderer.statistics()}, results.back());
  // The series does not change a later picture.
  const Picture after = renderer.render();
  EXPECT_EQ(after.layers[0].values, result_of(s, options).picture.layers[0].values);
}

TEST_P(SeriesOf, StoppedAnywhereItGivesWholePicturesOnly) {
  const scene::Scene s = room();
  RenderOptions options = picture_of(GetParam().integrator);
  GetParam().change(options);
  const Series series = series_of(options.integrator, {1, 3, 8}, {2, 3, 8});
  Renderer renderer(s, options);
  const std::vector<Result> straight = collect(renderer, series);
  std::vector<bool> seen(4, false);
  std::size_t pictures = 0;
  for (int stop_at = 1; pictures < 3; stop_at += 1 + stop_at / 8) {
    SCOPED_TRACE(stop_at);
    ASSERT_LT(stop_at, 1000);
    std::atomic<int> calls = 0;
    Callbacks callbacks;
    callbacks.stop = [&] { return ++calls == stop_at; };  // once
    std::vector<Result> stopped;
    const bool whole = renderer.render_series(
        series,
        [&](int, const Picture& picture, const RenderStatistics& statistics) {
          stopped.push_back({picture, statistics});
        },
        callbacks);
    pictures = stopped.size();
    EXPECT_EQ(whole, pictures == 3);
    seen[pictures] = true;
    for (std::size_t point = 0; point < pictures; ++point) expect_same(stopped[point], straight[point]);
  }
  EXPECT_EQ(seen, std::vector<bool>(4, true));
}

INSTANTIATE_TEST_SUITE_P(Kinds, SeriesOf, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(RenderSeries, SecondsAreThoseOfARunWithoutTheOtherPictures) {
  const scene::Scene s = room();
  for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
    const RenderOptions options = picture_of(integrator);
    Renderer renderer(s, options);
    const Clock::time_point start = Clock::now();
    RenderStatistics last;
    double rendered = 0.0;
    int pictures = 0;
    renderer.render_series(series_of(integrator, {2, 4, 8}, {1, 2, 4}), [&](int, const Picture&,
                                                                            const RenderStatistics& now) {
      EXPECT_GT(now.render_seconds, 0.0);
      if (integrator == Integrator::path) {
        EXPECT_GT(now.render_seconds, last.render_seconds) << "with the samples before";
        rendered = now.render_seconds;
      } else {
        EXPECT_GT(now.cache.train_seconds, last.cache.train_seconds) << "with the steps before";
        EXPECT_GT(now.cache.train_step_seconds, last.cache.train_step_seconds);
        EXPECT_EQ(now.cache.scout_seconds, pictures > 0 ? last.cache.scout_seconds : now.cache.scout_seconds);
        rendered += now.render_seconds;
      }
      last = now;
      ++pictures;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    });
    EXPECT_EQ(pictures, 3);
    EXPECT_LE(rendered + last.cache.train_seconds + last.cache.scout_seconds,
              seconds_since(start) - pictures * 0.05)
        << "the time of the caller does not count";
  }
}

TEST(RenderSeries, ContinuesWithALoadedCache) {
  const scene::Scene s = room();
  const TemporaryFolder folder;
  RenderOptions options = picture_of(Integrator::nrc);
  options.cache.cache_out = folder / "eight";
  const Result eight = result_of(s, options);
  options.cache.cache_in = options.cache.cache_out;
  options.cache.cache_out.clear();
  const Series series{.train_steps = {0, 5, 24}};  // groups of 8, 16
  Renderer renderer(s, options);
  const std::vector<Result> results = collect(renderer, series);
  ASSERT_EQ(results.size(), 3u);
  EXPECT_EQ(results[0].picture.layers[0].values, eight.picture.layers[0].values);
  for (std::size_t point = 0; point < 3; ++point) {
    expect_same(results[point], render_point(s, options, series, point));
    EXPECT_EQ(results[point].statistics.cache.steps, series.train_steps[point]);
  }
}

TEST(RenderSeries, ProgressRunsOnceOverTheWholeTraining) {
  const scene::Scene s = room();
  Renderer renderer(s, picture_of(Integrator::nrc));
  std::vector<Progress> training;
  Callbacks callbacks;
  callbacks.progress = [&](const Progress& p) {
    if (p.phase == Phase::train) training.push_back(p);
  };
  collect(renderer, {.train_steps = {2, 4, 8}}, callbacks);
  ASSERT_FALSE(training.empty());
  for (std::size_t i = 0; i < training.size(); ++i) {
    EXPECT_EQ(training[i].steps, 8);
    EXPECT_DOUBLE_EQ(training[i].fraction, training[i].steps_done / 8.0);
    if (i > 0) {
      EXPECT_GT(training[i].seconds, training[i - 1].seconds);
    }
  }
  EXPECT_EQ(training.back().steps_done, 8);
}

ErrorParts refusal(const scene::Scene& scene, const RenderOptions& options, const Series& series) {
  return tests::refused_parts<BadOption>([&] {
    Renderer(scene, options).render_series(series, [](int, const Picture&, const RenderStatistics&) {
      ADD_FAILURE() << "a picture of a refused series";
    });
  });
}

TEST(RenderSeries, InvalidSeriesAreRefused) {
  GATELIGHT_NEEDS_DENOISER();
  const scene::Scene s = room();
  const RenderOptions path = picture_of(Integrator::path);
  const RenderOptions nrc = picture_of(Integrator::nrc);
  expect_parts(refusal(s, path, {}), {"spp", "", "", "1"});
  expect_parts(refusal(s, nrc, {}), {"train-steps", "", "", "0"});
  expect_parts(refusal(s, path, {.spp = {1, 4, 4}}), {"spp", "1,4,4"});
  expect_parts(refusal(s, path, {.spp = {0, 4}}), {"spp", "0,4", "", "1"});
  expect_parts(refusal(s, nrc, {.train_steps = {8, 4}}), {"train-steps", "8,4"});
  expect_parts(refusal(s, nrc, {.train_steps = {-1, 4}}), {"train-steps", "-1,4", "", "0"});
  expect_parts(refusal(s, path, {.train_steps = {8}}), {"train-steps", "", "", "`spp`"});
  expect_parts(refusal(s, path, {.train_steps = {8}, .spp = {8}}), {"train-steps", "", "", "`spp`"});
  expect_parts(refusal(s, nrc, {.train_steps = {8}, .spp = {8}}), {"spp", "", "", "`train-steps`"});
  RenderOptions large = path;
  testing::denoise(large);
  large.denoise.supersampling = 2;
  expect_parts(refusal(s, large, {.spp = {4, 6}}), {"spp", "6", "", "multiple of 4"});
  RenderOptions screen = path;
  screen.sampler = SamplerKind::screen;
  expect_parts(refusal(s, screen, {.spp = {1, 4}}), {"sampler", "screen", "", "sobol"});
  const auto with = [&](const std::function<void(RenderOptions&)>& change) {
    RenderOptions changed = nrc;
    change(changed);
    return refusal(s, changed, {.train_steps = {8}});
  };
  expect_parts(with([](RenderOptions& o) { o.time_limit_seconds = 1.0; }), {"time-limit"});
  expect_parts(with([](RenderOptions& o) { o.max_error = 0.1; }), {"max-error"});
  expect_parts(with([](RenderOptions& o) { o.cache.train_seconds = 1.0; }), {"train-time"});
  expect_parts(with([](RenderOptions& o) { o.checkpoint.file = "c"; }), {"checkpoint"});
  expect_parts(with([](RenderOptions& o) { o.cache.cache_out = "c"; }), {"cache-out"});
}

}  // namespace
}  // namespace gatelight::renderer
