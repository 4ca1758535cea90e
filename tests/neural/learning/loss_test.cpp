#include "neural/reference/loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "neural/reference/record_gradient.h"
#include "neural/reference/reference_backend.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::reference {
namespace {

TEST(Loss, LuminanceWeighsThreeOutputsAndAveragesOthers) {
  EXPECT_DOUBLE_EQ(luminance(std::vector<double>{1, 10, 100}), 0.299 + 5.87 + 11.4);
  EXPECT_DOUBLE_EQ(luminance(std::vector<double>{2}), 2.0);
  EXPECT_DOUBLE_EQ(luminance(std::vector<double>{1, 2, 3, 6}), 3.0);
}

TEST(Loss, ValuesAreThoseWorkedByHand) {
  const std::vector<double> outputs = {1, 2, 3}, targets = {0, 2, 5};
  EXPECT_DOUBLE_EQ(loss_denominator(Loss::l2, outputs), 1.0);
  EXPECT_DOUBLE_EQ(loss_value(outputs, targets, 1.0), 1.0 + 0.0 + 4.0);
  const double y = 0.299 + 2 * 0.587 + 3 * 0.114;  // 1.815
  const double denominator = loss_denominator(Loss::relative_l2, outputs);
  EXPECT_DOUBLE_EQ(denominator, y * y + 0.01);
  EXPECT_DOUBLE_EQ(loss_value(outputs, targets, denominator), 5.0 / (1.815 * 1.815 + 0.01));
}

TEST(Loss, GradientTreatsTheDenominatorAsConstant) {
  const std::vector<double> outputs = {1, 2, 3}, targets = {0, 2, 5};
  std::vector<double> gradients(3);
  const double denominator = loss_denominator(Loss::relative_l2, outputs);
  loss_gradient(outputs, targets, denominator, 0.5, gradients);
  const double d = 1.815 * 1.815 + 0.01;
  EXPECT_DOUBLE_EQ(gradients[0], 0.5 * 2.0 * 1.0 / d);
  EXPECT_DOUBLE_EQ(gradients[1], 0.0);
  EXPECT_DOUBLE_EQ(gradients[2], 0.5 * 2.0 * -2.0 / d);
}

TEST(Loss, DarkOutputsHaveAFiniteLoss) {
  const std::vector<double> outputs = {0, 0, 0}, targets = {1, 1, 1};
  EXPECT_DOUBLE_EQ(loss_value(outputs, targets, loss_denominator(Loss::relative_l2, outputs)), 300.0);
}

TEST(Loss, LossOfAStepIsTheMeanOverRecordsAndOutputsBeforeIt) {
  for (const char* name : {"nrc", "nao", "outputs_7"})
    for (const Loss loss : {Loss::l2, Loss::relative_l2}) {
      const auto model = testing::find_model_case(name).model;
      const testing::OwnedBatch batch = testing::make_batch(*model, 37, 1);
      const TrainingOptions options{.loss = loss, .start_at_mean = false};
      const ModelState initial = initial_state(*model, options);
      const std::vector<double> parameters(initial.parameters.begin(), initial.parameters.end());
      const std::size_t outputs = model->config.mlp.outputs;
      double expected = 0;
      for (std::size_t r = 0; r < batch.size(); ++r) {
        const std::vector<double> y = evaluate(*model, parameters, read_point(*model, batch.points(), r));
        for (std::size_t o = 0; o < outputs; ++o)
          expected += std::pow(y[o] - batch.targets[r * outputs + o], 2) / loss_denominator(loss, y);
      }
      expected /= static_cast<double>(batch.size() * outputs);
      const auto backend = make_reference_backend(model, options);
      EXPECT_NEAR(backend->train(batch.training()).loss, expected, 1e-12 * expected);
    }
}

TEST(Loss, GradientOfAStepIsTheGradientOfTheMean) {
  for (const char* name : {"nrc", "hash_F4", "outputs_7"}) {
    const auto model = testing::find_model_case(name).model;
    const testing::OwnedBatch batch = testing::make_batch(*model, 23, 1);
    TrainingOptions options{.start_at_mean = false};
    options.adam.l2_network = 0;
    const ModelState initial = initial_state(*model, options);
    const std::vector<double> parameters(initial.parameters.begin(), initial.parameters.end());
    const std::size_t outputs = model->config.mlp.outputs;
    std::vector<double> gradients(parameters.size(), 0.0);
    for (std::size_t r = 0; r < batch.size(); ++r) {
      const std::vector<double> targets(
          batch.targets.begin() + static_cast<std::ptrdiff_t>(r * outputs),
          batch.targets.begin() + static_cast<std::ptrdiff_t>((r + 1) * outputs));
      add_record_gradient(*model, options.loss, parameters, read_point(*model, batch.points(), r), targets,
                          1.0 / static_cast<double>(batch.size() * outputs), gradients);
    }
    const auto backend = make_reference_backend(model, options);
    backend->train(batch.training());
    const ModelState state = backend->export_state();
    for (std::size_t p = 0; p < gradients.size(); ++p) {
      const double expected = (1 - static_cast<double>(options.adam.beta1)) * gradients[p];
      ASSERT_NEAR(state.first_moments[p], expected, 1e-6 * std::abs(expected)) << name << " " << p;
    }
  }
}

}  // namespace
}  // namespace gatelight::neural::reference
