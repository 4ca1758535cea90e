// Every gradient of the reference against central differences.
//
// Within one linear piece of the leaky ReLUs the outputs are affine in any single weight, bias, feature or
// input, so that the error with a constant denominator is quadratic and a central difference is exact up to
// rounding, for any step that crosses no kink.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "neural/model/state.h"
#include "neural/reference/encode.h"
#include "neural/reference/loss.h"
#include "neural/reference/mlp.h"
#include "neural/reference/record_gradient.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::reference {
namespace {

using testing::all_model_configs;
using testing::make_batch;
using testing::make_case;
using testing::ModelCase;
using testing::OwnedBatch;
using testing::Random;

constexpr std::size_t kRecords = 3;
constexpr double kRelativeTolerance = 1e-7;

struct Problem {
  ModelCase model_case;
  const Model& model;
  std::vector<double> parameters;
  std::vector<Point> points;
  std::vector<std::vector<double>> targets;

  explicit Problem(ModelCase c, std::uint64_t seed) : model_case(std::move(c)), model(*model_case.model) {
    const TrainingOptions options{.seed = seed};
    const ModelState state = initial_state(model, options);
    parameters.assign(state.parameters.begin(), state.parameters.end());
    Random random{seed + 1};
    for (std::size_t p = 0; p < model.parameters.network; ++p) parameters[p] = random.between(-1, 1);
    for (const LayerLayout& layer : model.parameters.layers)
      for (std::size_t o = 0; o < (model.parameters.biases ? layer.outputs : 0); ++o)
        parameters[layer.biases + o] = random.between(-0.5f, 0.5f);
    const OwnedBatch batch = make_batch(model, kRecords, seed + 2);
    const std::size_t outputs = model.config.mlp.outputs;
    for (std::size_t r = 0; r < kRecords; ++r) {
      points.push_back(read_point(model, batch.points(), r));
      targets.emplace_back(batch.targets.begin() + static_cast<std::ptrdiff_t>(r * outputs),
                           batch.targets.begin() + static_cast<std::ptrdiff_t>((r + 1) * outputs));
    }
  }

  /// Returns on which side of its kink each hidden unit of each record is.
  std::vector<bool> sides() const {
    std::vector<bool> result;
    for (const Point& point : points) append_sides(encode(model, parameters, point), result);
    return result;
  }
  void append_sides(std::span<const double> inputs, std::vector<bool>& result) const {
    const Activations activations = forward(model, parameters, inputs);
    for (std::size_t n = 1; n + 1 < activations.size(); ++n)
      for (const double value : activations[n]) result.push_back(value > 0.0);
  }
};

/// Central difference of f by x, with a step that leaves `sides` as they are; NaN where there is none.
double central_difference(double& x, const std::function<double()>& f,
                          const std::function<std::vector<bool>()>& sides, double& step) {
  const double middle = x;
  const std::vector<bool> here = sides();
  for (step = 1e-2; step > 1e-6; step /= 4) {
    const double above = middle + step, below = middle - step;
    x = above;
    const bool same_above = sides() == here;
    const double f_above = f();
    x = below;
    const bool same_below = sides() == here;
    const double f_below = f();
    x = middle;
    if (same_above && same_below) return (f_above - f_below) / (above - below);
  }
  return std::nan("");
}

/// Counts comparisons, so that a test can check that it made some.
struct Comparison {
  int compared = 0;     ///< gradients large enough for the tolerance to be above the rounding of f
  int near_a_kink = 0;  ///< skipped
  int total = 0;

  void compare(double gradient, double difference, double value, double step, const std::string& what) {
    ++total;
    if (std::isnan(difference)) {
      ++near_a_kink;
      return;
    }
    const double rounding = 1e-14 * std::abs(value) / step;
    if (std::abs(gradient) * kRelativeTolerance > rounding) ++compared;
    EXPECT_NEAR(difference, gradient, kRelativeTolerance * std::abs(gradient) + rounding) << what;
  }
};

double mean_error(const Problem& problem, std::span<const double> denominators) {
  double sum = 0;
  for (std::size_t r = 0; r < kRecords; ++r)
    sum += loss_value(evaluate(problem.model, problem.parameters, problem.points[r]), problem.targets[r],
                      denominators[r]);
  return sum / static_cast<double>(kRecords * problem.model.config.mlp.outputs);
}

/// Compares the gradient of the mean error with central differences at the `chosen` parameters.
void compare_parameters(Problem& problem, Loss loss, const std::vector<std::size_t>& chosen,
                        Comparison& comparison) {
  const Model& model = problem.model;
  std::vector<double> gradients(problem.parameters.size(), 0.0), denominators;
  const double scale = 1.0 / static_cast<double>(kRecords * model.config.mlp.outputs);
  for (std::size_t r = 0; r < kRecords; ++r) {
    denominators.push_back(loss_denominator(loss, evaluate(model, problem.parameters, problem.points[r])));
    add_record_gradient(model, loss, problem.parameters, problem.points[r], problem.targets[r], scale,
                        gradients);
  }
  const auto error = [&] { return mean_error(problem, denominators); };
  for (const std::size_t p : chosen) {
    double step = 0;
    const double difference = central_difference(
        problem.parameters[p], error, [&] { return problem.sides(); }, step);
    comparison.compare(gradients[p], difference, error(), step, "parameter " + std::to_string(p));
  }
}

constexpr Loss kLosses[] = {Loss::l2, Loss::relative_l2};

/// Some parameters of each layer, and of the nodes that the points read.
std::vector<std::size_t> some_parameters(const Problem& problem, std::uint64_t seed) {
  const ParameterLayout& layout = problem.model.parameters;
  Random random{seed};
  std::vector<std::size_t> chosen, features;
  for (const LayerLayout& layer : layout.layers) {
    for (int i = 0; i < 6; ++i) chosen.push_back(layer.weights + random.below(layer.inputs * layer.outputs));
    for (int i = 0; layout.biases && i < 2; ++i) chosen.push_back(layer.biases + random.below(layer.outputs));
  }
  for (const Point& point : problem.points)
    for (const NodeWeight& node : encoding_nodes(problem.model, point))
      features.push_back(std::size_t{node.node} * layout.features + random.below(layout.features));
  while (features.size() > 24)
    features.erase(features.begin() + random.below(static_cast<std::uint32_t>(features.size())));
  chosen.insert(chosen.end(), features.begin(), features.end());
  return chosen;
}

TEST(Gradient, OfSomeParametersOfEveryModelAgreesWithCentralDifferences) {
  std::uint64_t seed = 100;
  for (const auto& [name, config] : all_model_configs()) {
    SCOPED_TRACE(name);
    Problem problem(make_case(name, config), seed += 10);
    for (const Loss loss : kLosses) {
      Comparison comparison;
      compare_parameters(problem, loss, some_parameters(problem, seed), comparison);
      EXPECT_GT(comparison.compared, comparison.total / 4);
      EXPECT_LE(comparison.near_a_kink, comparison.total / 10);
    }
  }
}

TEST(Gradient, OfEveryParameterOfASmallNetworkAgreesWithCentralDifferences) {
  ModelConfig config = testing::default_gate_config();
  config.mlp = {16, 2, 2, 0.1f, true};
  config.gate.features = 2;
  Problem problem(make_case("small", config), 7);
  std::vector<std::size_t> all;
  for (std::size_t p = problem.model.parameters.network; p < problem.parameters.size(); ++p) all.push_back(p);
  for (const Loss loss : kLosses) {
    Comparison comparison;
    compare_parameters(problem, loss, all, comparison);
    EXPECT_GT(comparison.compared, comparison.total * 9 / 10);
  }
}

TEST(Gradient, OfNetworkInputsAgreesWithCentralDifferences) {
  std::uint64_t seed = 9000;
  for (const auto& [name, config] : all_model_configs()) {
    SCOPED_TRACE(name);
    const Problem problem(make_case(name, config), seed += 10);
    const Model& model = problem.model;
    std::vector<double> inputs = encode(model, problem.parameters, problem.points[0]),
                        unused(problem.parameters.size());
    const Activations activations = forward(model, problem.parameters, inputs);
    std::vector<double> dy(model.config.mlp.outputs);
    loss_gradient(activations.back(), problem.targets[0], 0.7, 1.0, dy);
    const std::vector<double> dx = backward(model, problem.parameters, activations, dy, unused);
    const auto error = [&] {
      return loss_value(forward(model, problem.parameters, inputs).back(), problem.targets[0], 0.7);
    };
    const auto sides = [&] {
      std::vector<bool> result;
      problem.append_sides(inputs, result);
      return result;
    };
    ASSERT_EQ(dx.size(), inputs.size());
    Comparison comparison;
    for (std::size_t i = 0; i < inputs.size(); i += 1 + inputs.size() / 16) {
      double step = 0;
      const double difference = central_difference(inputs[i], error, sides, step);
      comparison.compare(dx[i], difference, error(), step, "input " + std::to_string(i));
    }
    EXPECT_GT(comparison.compared, comparison.total / 4);
  }
}

}  // namespace
}  // namespace gatelight::neural::reference
