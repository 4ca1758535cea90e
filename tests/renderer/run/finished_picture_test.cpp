// Pictures with --reconstruct on: what the renderer gives is what reconstruction makes of its samples.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/reconstruction/reconstruct.h"
#include "renderer/render.h"
#include "renderer/settings/words.h"
#include "tests/support/room.h"

namespace gatelight::renderer {
namespace {

using testing::room;

class FinishedPicture : public ::testing::TestWithParam<Integrator> {
 protected:
  Picture render(bool reconstruct, const std::vector<Aov>& aovs) {
    RenderOptions options = testing::small_picture();
    options.integrator = GetParam();
    options.width = 40;
    options.height = 24;
    options.spp = 6;
    options.cache.train_steps = 4;
    options.cache.batch = 500;
    options.reconstruct = reconstruct;
    options.adaptive = false;
    options.aovs = aovs;
    Renderer renderer(scene, options);
    Picture picture = renderer.render();
    reconstruct_seconds = renderer.statistics().reconstruct_seconds;
    return picture;
  }

  Reconstruction reconstruct_samples() {
    Picture picture = render(false, {Aov::reconstruction});
    SampledPicture samples = take_samples(picture);
    if (GetParam() == Integrator::ao || GetParam() == Integrator::nao)
      std::fill(samples.albedo.begin(), samples.albedo.end(), 1.0f);
    return reconstruct(samples);
  }

  const scene::Scene scene = room();
  double reconstruct_seconds = -1.0;
};

TEST_P(FinishedPicture, IsReconstructedFromTheSamples) {
  const Reconstruction expected = reconstruct_samples();
  const Picture samples = render(false, {});
  EXPECT_EQ(reconstruct_seconds, 0.0);
  const Picture finished = render(true, {Aov::raw, Aov::error});
  EXPECT_GT(reconstruct_seconds, 0.0);
  ASSERT_EQ(finished.layers.size(), 3u) << "guides and halves are left out";
  EXPECT_NE(finished.layers[0].values, samples.layers[0].values);
  EXPECT_EQ(finished.layers[0].values, expected.color);
  EXPECT_EQ(finished.find("raw")->values, samples.layers[0].values);
  EXPECT_EQ(finished.find("error")->values, expected.error);
  EXPECT_EQ(render(true, {}).layers.size(), 1u);
}

TEST_P(FinishedPicture, KeepsTheLayersThatReconstructionReads) {
  const Picture samples = render(false, {Aov::reconstruction, Aov::position});
  const Picture finished = render(true, {Aov::reconstruction, Aov::position});
  ASSERT_EQ(finished.layers.size(), samples.layers.size());
  for (std::size_t i = 1; i < samples.layers.size(); ++i)
    EXPECT_EQ(finished.layers[i].values, samples.layers[i].values) << samples.layers[i].name;
}

TEST_P(FinishedPicture, WithoutReconstructionTheSamplesTellTheError) {
  const Picture samples = render(false, {Aov::variance, Aov::raw, Aov::error});
  EXPECT_EQ(samples.find("raw")->values, samples.layers[0].values);
  const std::vector<float>& variance = samples.find("variance")->values;
  EXPECT_GT(*std::max_element(variance.begin(), variance.end()), 0.0f);
  for (std::size_t i = 0; i < variance.size(); ++i)
    ASSERT_FLOAT_EQ(samples.find("error")->values[i], std::sqrt(variance[i]));
}

INSTANTIATE_TEST_SUITE_P(Integrators, FinishedPicture,
                         ::testing::Values(Integrator::path, Integrator::ao, Integrator::nrc,
                                           Integrator::nao),
                         [](const auto& parameter) { return word(parameter.param); });

}  // namespace
}  // namespace gatelight::renderer
