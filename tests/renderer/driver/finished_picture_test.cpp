// Finished pictures: the renderer's result is the denoiser's result for its samples.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "renderer/metrics/compare.h"
#include "renderer/render.h"
#include "renderer/settings/enum_names.h"
#include "tests/support/denoiser.h"
#include "tests/support/room.h"

namespace gatelight::renderer {
namespace {

using testing::room;
using Kind = BackgroundOptions::Kind;

class FinishedPicture : public ::testing::TestWithParam<Integrator> {
 protected:
  RenderOptions options(const std::vector<Aov>& aovs = {}) const {
    RenderOptions options = testing::small_picture();
    options.integrator = GetParam();
    options.width = 40;
    options.height = 24;
    options.spp = 8;
    options.cache.train_steps = 4;
    options.cache.batch = 500;
    options.aovs = aovs;
    return options;
  }
  RenderOptions denoised(const std::vector<Aov>& aovs = {}) const {
    RenderOptions o = options(aovs);
    testing::denoise(o);
    return o;
  }
  Picture render(const RenderOptions& options) {
    Renderer renderer(scene, options);
    Picture picture = renderer.render();
    statistics = renderer.statistics();
    return picture;
  }

  const scene::Scene scene = room();
  RenderStatistics statistics;
};

TEST_P(FinishedPicture, IsDenoisedAndItsSamplesStayLayers) {
  GATELIGHT_NEEDS_DENOISER();
  const Picture samples = render(options());
  EXPECT_EQ(statistics.denoise_seconds, 0.0);
  EXPECT_EQ(statistics.denoiser, "");
  const Picture finished = render(denoised({Aov::raw, Aov::error, Aov::position}));
  EXPECT_GT(statistics.denoise_seconds, 0.0);
  EXPECT_TRUE(statistics.denoiser.starts_with("Open Image Denoise 2."));
  EXPECT_EQ(statistics.denoise_failure, "");
  ASSERT_EQ(finished.layers.size(), 4u) << "guides and halves are left out";
  EXPECT_NE(finished.layers[0].values, samples.layers[0].values);
  EXPECT_EQ(finished.find("raw")->values, samples.layers[0].values);
  EXPECT_EQ(render(denoised()).layers[0].values, finished.layers[0].values);
}

TEST_P(FinishedPicture, SupersampledHasTheSizeAndTheSamplesOfThePicture) {
  GATELIGHT_NEEDS_DENOISER();
  RenderOptions o = denoised({Aov::raw, Aov::sample_count, Aov::depth, Aov::instance_id, Aov::variance});
  o.denoise.supersampling = 2;
  o.region = {{4, 2, 36, 22}};
  const Picture picture = render(o);
  EXPECT_EQ(picture.width, 32);
  EXPECT_EQ(picture.height, 20);
  EXPECT_EQ(picture.x0, 4);
  EXPECT_EQ(picture.y0, 2);
  EXPECT_EQ(picture.full_width, 40);
  EXPECT_EQ(statistics.width, 32);
  EXPECT_EQ(statistics.spp, 8);
  EXPECT_EQ(statistics.samples, 32u * 20u * 8u);
  for (const Layer& layer : picture.layers)
    ASSERT_EQ(layer.values.size(), 640 * layer.channels.size()) << layer.name;
  for (const float count : picture.find("samples")->values) EXPECT_EQ(count, 8.0f);
  RenderOptions plain = options({Aov::depth, Aov::raw});
  plain.region = o.region;
  plain.spp = 256;
  const Picture reference = render(plain);
  // Depths are those of points half a pixel apart at most, but at edges.
  int alike = 0;
  for (std::size_t i = 0; i < 640; ++i) {
    const float near = picture.find("depth")->values[i], expected = reference.find("depth")->values[i];
    if (std::abs(near - expected) < 0.05f * expected) ++alike;
  }
  EXPECT_GT(alike, 450);
  double mean = 0.0, of_reference = 0.0;
  for (std::size_t i = 0; i < 3 * 640; ++i) {
    mean += static_cast<double>(picture.find("raw")->values[i]);
    of_reference += static_cast<double>(reference.find("raw")->values[i]);
  }
  if (!uses_cache(GetParam())) {
    EXPECT_NEAR(mean / of_reference, 1.0, 0.05);
  }
}

TEST_P(FinishedPicture, HasLessErrorThanItsSamples) {
  GATELIGHT_NEEDS_DENOISER();
  RenderOptions many = options();
  many.integrator = GetParam() == Integrator::nrc   ? Integrator::path
                    : GetParam() == Integrator::nao ? Integrator::ao
                                                    : GetParam();
  many.spp = 256;  // a thirtieth of the error of few samples
  many.seed = 9;
  const Picture reference = render(many);
  const auto error_of = [&](const RenderOptions& o) {
    return compare_pictures({reference, "reference"}, {render(o), "test"}).rel_mse;
  };
  RenderOptions few = options();
  few.cache.train_steps = 64;
  const double raw = error_of(few);
  testing::denoise(few);
  const double clean = error_of(few);
  few.denoise.supersampling = 2;
  const double supersampled = error_of(few);
  // Answers of a cache at the primary hit have no noise.
  const double share = GetParam() == Integrator::nao ? 1.1 : 0.7;
  EXPECT_LT(clean, share * raw);
  EXPECT_LT(supersampled, share * raw);
}

TEST_P(FinishedPicture, WithoutADenoiserTheErrorIsThatOfTheSamples) {
  const Picture samples = render(options({Aov::variance, Aov::raw, Aov::error}));
  EXPECT_EQ(samples.find("raw")->values, samples.layers[0].values);
  const std::vector<float>& variance = samples.find("variance")->values;
  EXPECT_GT(*std::max_element(variance.begin(), variance.end()), 0.0f);
  for (std::size_t i = 0; i < variance.size(); ++i)
    ASSERT_FLOAT_EQ(samples.find("error")->values[i], std::sqrt(variance[i]));
}

TEST_P(FinishedPicture, WithoutTheLibraryIsTheMeanWithAWarning) {
  RenderOptions o = options();
  const Picture samples = render(o);
  o.denoise = {.denoiser = DenoiserKind::automatic, .supersampling = 2, .library = "/none"};
  const Picture picture = render(o);
  EXPECT_EQ(picture.layers[0].values, samples.layers[0].values);
  ASSERT_FALSE(statistics.warnings.empty());
  EXPECT_NE(statistics.warnings[0].find("/none"), std::string::npos);
  o.denoise.denoiser = DenoiserKind::oidn;
  EXPECT_THROW(Renderer(scene, o), MissingDenoiser);
}

TEST_P(FinishedPicture, ThatIsStoppedWhileItIsDenoisedIsTheMeanOfItsSamples) {
  GATELIGHT_NEEDS_DENOISER();
  const Picture samples = render(options());
  std::atomic<bool> denoising{false};
  Callbacks callbacks;
  callbacks.progress = [&](const Progress& p) {
    if (p.phase == Phase::denoise) denoising = true;
  };
  callbacks.stop = [&] { return denoising.load(); };
  Renderer renderer(scene, denoised());
  const Picture picture = renderer.render(callbacks);
  EXPECT_EQ(picture.layers[0].values, samples.layers[0].values);
  EXPECT_TRUE(renderer.statistics().interrupted);
  EXPECT_EQ(renderer.statistics().ended_by, EndedBy::caller);
  EXPECT_EQ(renderer.statistics().denoiser, "");
  EXPECT_NE(renderer.statistics().denoise_failure, "");
  // A picture that was stopped before is still denoised.
  callbacks.stop = [] { return true; };
  Renderer early(scene, denoised());
  early.render(callbacks);
  EXPECT_NE(early.statistics().denoiser, "");
}

INSTANTIATE_TEST_SUITE_P(Integrators, FinishedPicture,
                         ::testing::Values(Integrator::path, Integrator::ao, Integrator::nrc,
                                           Integrator::nao),
                         [](const auto& parameter) { return enum_name(parameter.param); });

}  // namespace
}  // namespace gatelight::renderer
