// Pictures that end by their estimated error.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "renderer/metrics/compare.h"
#include "renderer/render.h"
#include "tests/support/denoiser.h"
#include "tests/support/room.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using testing::room;
using tests::TemporaryFolder;

struct MeasuredPicture {
  Picture picture;
  RenderStatistics statistics;
};

struct Method {
  const char* name;
  Integrator integrator;
  bool denoised;
};

class MaxError : public ::testing::TestWithParam<Method> {
 protected:
  void SetUp() override {
    if (GetParam().denoised) GATELIGHT_NEEDS_DENOISER();
  }
  RenderOptions options() const {
    RenderOptions options = testing::small_picture();
    options.integrator = GetParam().integrator;
    if (GetParam().denoised) testing::denoise(options);
    options.width = 40;
    options.height = 24;
    options.spp = 100000;
    options.cache.train_steps = 4;
    options.cache.batch = 500;
    return options;
  }

  MeasuredPicture render(const RenderOptions& options, int stop_at = 0) const {
    Renderer renderer(scene, options);
    std::atomic<int> calls{0};
    Callbacks callbacks;
    callbacks.stop = [&] { return ++calls == stop_at; };
    callbacks.progress = [&](const Progress& p) {
      if (p.phase == Phase::render && p.error) reported = *p.error;
    };
    MeasuredPicture result{renderer.render(callbacks), {}};
    result.statistics = renderer.statistics();
    return result;
  }

  /// The estimate of a picture of `spp` samples.
  double error_of(int spp) const {
    RenderOptions some = options();
    some.spp = spp;
    return render(some).statistics.estimated_error.value();
  }

  const scene::Scene scene = room();
  mutable double reported = -1.0;
};

TEST_P(MaxError, EndsAtTheFirstCheckThatReachesIt) {
  // Estimates of small pictures do not always fall: the last check that is better than all before it.
  int last = 4;
  double least = error_of(last);
  for (const int check : {6, 8, 11, 16}) {
    const double error = error_of(check);
    if (!(error < 0.999 * least)) continue;
    last = check;
    least = error;
  }
  ASSERT_GT(last, 6) << "the case tests nothing";
  const double goal = 1.0005 * least;
  RenderOptions limited = options();
  limited.max_error = goal;
  const MeasuredPicture result = render(limited);
  EXPECT_EQ(result.statistics.spp, last);
  EXPECT_EQ(result.statistics.ended_by, EndedBy::max_error);
  EXPECT_FALSE(result.statistics.interrupted);
  EXPECT_LE(result.statistics.estimated_error.value(), goal);
  EXPECT_NEAR(reported, *result.statistics.estimated_error, 1e-12) << "progress reports it";
  limited.max_error = 0.0;
  limited.spp = last;
  EXPECT_EQ(render(limited).picture.layers[0].values, result.picture.layers[0].values)
      << "the picture is that of as many samples";
}

TEST_P(MaxError, TheSamplesLimitIt) {
  RenderOptions limited = options();
  limited.max_error = 1e-6;
  limited.spp = 9;  // no check
  const MeasuredPicture result = render(limited);
  EXPECT_EQ(result.statistics.spp, 9);
  EXPECT_EQ(result.statistics.ended_by, EndedBy::spp);
  EXPECT_FALSE(result.statistics.interrupted);
  EXPECT_GT(result.statistics.estimated_error.value(), 1e-6);
}

TEST_P(MaxError, AResumedPictureEndsWithTheSameSamples) {
  RenderOptions limited = options();
  limited.max_error = 1.001 * error_of(11);
  const MeasuredPicture straight = render(limited);
  const TemporaryFolder folder;
  limited.checkpoint.file = folder / "picture";
  limited.checkpoint.resume = true;
  const MeasuredPicture stopped = render(limited, uses_cache(limited.integrator) ? 8 : 5);
  EXPECT_EQ(stopped.statistics.ended_by, EndedBy::caller);
  EXPECT_TRUE(stopped.statistics.interrupted);
  // The second time it is over already.
  for (int time = 0; time < 2; ++time) {
    const MeasuredPicture resumed = render(limited);
    EXPECT_EQ(resumed.statistics.spp, straight.statistics.spp);
    EXPECT_EQ(resumed.statistics.ended_by, EndedBy::max_error);
    EXPECT_EQ(resumed.picture.layers[0].values, straight.picture.layers[0].values);
  }
}

TEST_P(MaxError, ATimeLimitGivesAPicture) {
  RenderOptions timed = options();
  timed.cache.train_steps.reset();
  timed.spp = kUnlimitedSpp;
  timed.time_limit_seconds = 0.3;
  const MeasuredPicture result = render(timed);
  EXPECT_EQ(result.statistics.ended_by, EndedBy::time_limit);
  EXPECT_TRUE(result.statistics.interrupted);
  EXPECT_GE(result.statistics.spp, 1);
  const std::uint64_t pixels = 40 * 24;
  const auto passes = static_cast<std::uint64_t>(result.statistics.spp);
  EXPECT_GE(result.statistics.samples, pixels * passes);
  EXPECT_LT(result.statistics.samples, pixels * (passes + 1));
  if (!uses_cache(timed.integrator)) {
    EXPECT_EQ(result.statistics.samples, result.statistics.rays.camera)
        << "the last pass has only the samples that were begun";
  }
  for (const float value : result.picture.layers[0].values) ASSERT_TRUE(std::isfinite(value));
}

INSTANTIATE_TEST_SUITE_P(Kinds, MaxError,
                         ::testing::Values(Method{"path", Integrator::path, false},
                                           Method{"denoised", Integrator::path, true},
                                           Method{"nrc", Integrator::nrc, true}),
                         [](const auto& parameter) { return parameter.param.name; });

/// The true error, against many samples of another seed.
TEST(EstimatedError, OfSamplesIsTheTrueOne) {
  const scene::Scene scene = room();
  RenderOptions options = testing::small_picture();
  options.width = 64;
  options.height = 48;
  options.sampler = SamplerKind::independent;
  options.spp = 2048;
  const Picture reference = Renderer(scene, options).render();
  options.seed = 1;
  for (const bool denoised : {false, true}) {
    if (denoised) GATELIGHT_NEEDS_DENOISER();
    if (denoised) testing::denoise(options);
    options.spp = 16;
    Renderer renderer(scene, options);
    const Picture picture = renderer.render();
    const double error = std::sqrt(compare_pictures({reference, "reference"}, {picture, "test"}).rel_mse);
    const double estimate = renderer.statistics().estimated_error.value();
    EXPECT_LT(estimate, 1.5 * error) << denoised;
    EXPECT_GT(estimate, error / 1.5) << denoised;
  }
}

}  // namespace
}  // namespace gatelight::renderer
