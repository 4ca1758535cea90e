// The initial state of training: parameters and counters.

#include "neural/model/state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/half.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural {
namespace {

std::size_t count_not_halves(const ModelState& state, std::uint64_t features) {
  const auto is_half = [](float value) { return half_to_float(float_to_half(value)) == value; };
  return static_cast<std::size_t>(std::count_if(
      state.parameters.begin(), state.parameters.begin() + static_cast<std::ptrdiff_t>(features),
      [&](float value) { return !is_half(value); }));
}

TEST(InitialState, FeaturesHaveTheirPrecision) {
  const auto model = testing::find_model_case("nrc").model;
  const std::uint64_t features = model->parameters.network;
  TrainingOptions options;
  EXPECT_GT(count_not_halves(initial_state(*model, options), features), features / 2);
  for (const FeaturePrecision precision : {FeaturePrecision::fp16_masters, FeaturePrecision::fp16}) {
    options.precision = precision;
    EXPECT_EQ(count_not_halves(initial_state(*model, options), features), 0u);
  }
}

TEST(InitialState, WeightsAreUniformInGlorotsRangeAndBiasesZero) {
  const auto model = testing::find_model_case("nrc").model;
  const ModelState state = initial_state(*model, {});
  for (const LayerLayout& layer : model->parameters.layers) {
    const double range = std::sqrt(6.0 / (layer.inputs + layer.outputs));
    const double count = static_cast<double>(layer.biases - layer.weights);
    double greatest = 0.0, sum = 0.0, squares = 0.0;
    for (std::uint64_t i = layer.weights; i < layer.biases; ++i) {
      const double weight = static_cast<double>(state.parameters[i]);
      greatest = std::max(greatest, std::abs(weight));
      sum += weight;
      squares += weight * weight;
    }
    EXPECT_LE(greatest, range * (1.0 + 1e-6));
    EXPECT_GT(greatest, 0.9 * range);
    // Five standard deviations of the mean and of the mean square of uniform numbers.
    EXPECT_NEAR(sum / count, 0.0, 5.0 * range / std::sqrt(3.0 * count));
    EXPECT_NEAR(squares / count, range * range / 3.0, 5.0 * range * range * std::sqrt(4.0 / 45.0 / count));
    for (std::uint64_t o = 0; o < layer.outputs; ++o) EXPECT_EQ(state.parameters[layer.biases + o], 0.0f);
  }
}

TEST(InitialState, HasTheCountersThatTheOptionsNeed) {
  const auto model = testing::find_model_case("nrc").model;
  TrainingOptions options;
  const ModelState sparse = initial_state(*model, options);
  EXPECT_EQ(sparse.averages, sparse.parameters);
  EXPECT_EQ(sparse.node_steps.size(), model->parameters.node_count);
  EXPECT_TRUE(sparse.triangle_steps.empty());
  options.update = FeatureUpdate::dense;
  EXPECT_TRUE(initial_state(*model, options).node_steps.empty());
  options.count_triangles = true;
  EXPECT_EQ(initial_state(*model, options).triangle_steps.size(), model->gate.triangle_count);
  options.count_triangles = false;
  options.feature_step = FeatureStep::per_triangle;
  EXPECT_EQ(initial_state(*model, options).triangle_steps.size(), model->gate.triangle_count);
}

}  // namespace
}  // namespace gatelight::neural
