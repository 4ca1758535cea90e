#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "neural/learning/adam.h"
#include "neural/reference/reference_backend.h"
#include "tests/support/agreement.h"

namespace gatelight::neural::reference {
namespace {

using testing::find_model_case;
using testing::make_batch;
using testing::OwnedBatch;

double averaged(const AverageOptions& options, std::uint64_t t, double average, double parameter) {
  return average + average_rate(options, t) * (parameter - average);
}

TEST(Average, RateFallsFromOneToItsLimit) {
  const AverageOptions options;  // 0.99, 10
  EXPECT_EQ(average_rate(options, 1), 1.0) << "the first step copies";
  EXPECT_DOUBLE_EQ(average_rate(options, 2), 1 / 1.1);
  EXPECT_DOUBLE_EQ(average_rate(options, 11), 0.5);
  EXPECT_NEAR(average_rate(options, 990), 1 / 99.9, 1e-15);
  EXPECT_EQ(average_rate(options, 1000), 1.0 - 0.99f);
  EXPECT_EQ(average_rate(options, 1000000000), 1.0 - 0.99f);
}

TEST(Average, RampOfOneIsTheArithmeticMean) {
  const AverageOptions options{true, true, 1 - 0x1p-20f, 1.0f};
  double average = 123, sum = 0;
  for (std::uint64_t t = 1; t <= 1000; ++t) {
    const double value = std::sin(static_cast<double>(t * t));
    sum += value;
    average = averaged(options, t, average, value);
    EXPECT_NEAR(average, sum / static_cast<double>(t), 1e-13);
  }
}

TEST(Average, NetworkCountsStepsAndFeaturesCountTheirOwn) {
  const auto model = find_model_case("nrc").model;
  TrainingOptions options;
  const auto backend = make_reference_backend(model, options);
  ModelState before = backend->export_state();
  for (std::uint64_t step = 1; step <= 12; ++step) {
    backend->train(make_batch(*model, step % 3 == 0 ? 40 : 3, step).training());
    const ModelState after = backend->export_state();
    const std::size_t features = model->parameters.features;
    for (std::size_t p = 0; p < after.parameters.size(); ++p) {
      const bool network = p >= model->parameters.network;
      const bool touched = network || after.node_steps[p / features] != before.node_steps[p / features];
      const std::uint64_t t = network ? step : after.node_steps[p / features];
      const double expected = touched ? averaged(options.average, t, before.averages[p], after.parameters[p])
                                      : before.averages[p];
      ASSERT_NEAR(after.averages[p], expected, 1e-6 * std::abs(expected) + 1e-9) << p;
    }
    before = after;
  }
}

TEST(Average, EqualsTheParametersWhereItIsOff) {
  const auto model = find_model_case("nrc").model;
  for (const bool network : {false, true})
    for (const bool features : {false, true}) {
      TrainingOptions options;
      options.average.network = network;
      options.average.features = features;
      const auto backend = make_reference_backend(model, options);
      for (std::uint64_t step = 0; step < 4; ++step) backend->train(make_batch(*model, 200, step).training());
      const ModelState state = backend->export_state();
      const auto split = static_cast<std::ptrdiff_t>(model->parameters.network);
      const bool features_equal =
          std::equal(state.averages.begin(), state.averages.begin() + split, state.parameters.begin());
      const bool network_equal =
          std::equal(state.averages.begin() + split, state.averages.end(), state.parameters.begin() + split);
      EXPECT_EQ(features_equal, !features);
      EXPECT_EQ(network_equal, !network);
    }
}

TEST(Average, IsReadByQueriesUnlessTheyRequestRawParameters) {
  const auto model = find_model_case("nrc").model;
  const auto backend = make_reference_backend(model, {});
  for (std::uint64_t step = 0; step < 5; ++step) backend->train(make_batch(*model, 100, step).training());
  const OwnedBatch points = make_batch(*model, 30, 99);
  const auto answers = [&](const Backend& from, bool averages) {
    return testing::raw_answers(from, *model, points, averages);
  };
  ModelState swapped = backend->export_state();
  std::swap(swapped.parameters, swapped.averages);
  const auto other = make_reference_backend(model, {});
  other->import_state(swapped);
  EXPECT_NE(answers(*backend, true), answers(*backend, false));
  const std::vector<float> averaged_answers = answers(*backend, true), raw = answers(*other, false);
  for (std::size_t i = 0; i < raw.size(); ++i) EXPECT_NEAR(averaged_answers[i], raw[i], 1e-5);
}

}  // namespace
}  // namespace gatelight::neural::reference
