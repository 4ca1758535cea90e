// Training: extremes of the targets.

#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;

std::vector<ModelCase> usual_cases() {
  return {find_model_case("nrc"), find_model_case("nao"), find_model_case("hash_with_everything")};
}

/// The greatest |answer - target| of the batch after `steps` steps.
double error_after(Backend& backend, const Model& model, const OwnedBatch& batch, int steps) {
  for (int step = 0; step < steps; ++step) backend.train(batch.training());
  const std::vector<float> out = raw_answers(backend, model, batch);
  double worst = 0;
  for (std::size_t i = 0; i < out.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(out[i]) - batch.targets[i]));
  return worst;
}

TEST(ExtremeTargets, OneRecordIsFitted) {
  for (const ModelCase& c : usual_cases()) {
    const OwnedBatch batch = make_batch(*c.model, 1, 9);
    const auto fast = cpu::make_cpu_backend(c.model, {});
    EXPECT_LE(error_after(*fast, *c.model, batch, 500), 1e-3) << c.name;
    expect_sound(*fast, *c.model, batch);
  }
}

TEST(ExtremeTargets, RecordsOfOneTriangleAgreeWithTheReference) {
  FastAgreement agreement;
  std::uint64_t most = 0;
  for (const char* name : {"nrc", "nao", "gate_L5_per_triangle_stack_5_a_1", "gate_L2_stack_64"}) {
    const ModelCase c = find_model_case(name);
    for (const FeatureStep step : {FeatureStep::per_node, FeatureStep::per_triangle}) {
      TrainingOptions options = smooth_options();
      options.feature_step = step;
      const ModelState state = random_state(*c.model, options, 3, false);
      const OwnedBatch batch = make_smooth_batch(*c.model, state, 4999, 3, {.crowded = 1.0f});
      agreement.expect_same("one triangle", c, options, state, batch);
      for (const auto& fast : fast_backends(c.model, options)) {
        fast->import_state(state);
        most = std::max(most, fast->train(batch.training()).touched_nodes);
        expect_sound(*fast, *c.model, batch);
      }
    }
  }
  // 65 x 66 / 2 nodes of R = 64.
  EXPECT_LE(most, 2145u);
}

TEST(ExtremeTargets, EqualTargetsAreLearned) {
  FastAgreement agreement;
  for (const ModelCase& c : usual_cases())
    for (const auto& [value, loss] : {std::pair{0.0f, Loss::l2},
                                      {0.0f, Loss::relative_l2},
                                      {1e-6f, Loss::relative_l2},
                                      {0.7f, Loss::relative_l2},
                                      {1e6f, Loss::relative_l2}}) {
      TrainingOptions options = smooth_options();
      options.loss = loss;
      options.adam.epsilon = std::max(value, 1.0f);  // of the size of the gradients
      const ModelState state = random_state(*c.model, options, 5, true);
      OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 5, {});
      for (float& target : batch.targets)
        if (std::isfinite(target)) target = value > 0.0f && value < 10.0f ? 7.0f : value;
      agreement.expect_same("equal", c, options, state, batch);

      OwnedBatch equal = make_batch(*c.model, 96, 5);
      std::fill(equal.targets.begin(), equal.targets.end(), value);
      TrainingOptions plain;
      plain.loss = loss;
      const auto fast = cpu::make_cpu_backend(c.model, plain);
      // Three learning rates.
      EXPECT_LE(error_after(*fast, *c.model, equal, 300), 0.03 * std::max(1.0f, value)) << c.name << value;
      expect_sound(*fast, *c.model, equal);
    }
}

// Adam remembers the square of a gradient for as long as it is above the usual ones.
TEST(ExtremeTargets, OneTargetOf1e30IsClampedAndForgotten) {
  FastAgreement agreement;
  for (const ModelCase& c : usual_cases()) {
    TrainingOptions options = smooth_options();
    options.adam.epsilon = options.max_target;
    const ModelState state = random_state(*c.model, options, 6, true);
    OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 6, {});
    const std::size_t outputs = c.model->config.mlp.outputs;
    std::size_t record = 40;
    while (batch.fates[record] != Fate::accepted) ++record;
    batch.targets[record * outputs] = 1e30f;
    agreement.expect_same("1e30", c, options, state, batch);

    // Later on and in the first batch, which sets the output's bias.
    const OwnedBatch usual = make_batch(*c.model, 96, 6);
    OwnedBatch one = usual;
    one.targets[50 * outputs] = 1e30f;
    for (const int before : {0, 50}) {
      const auto fast = cpu::make_cpu_backend(c.model, {});
      for (int step = 0; step < before; ++step) fast->train(usual.training());
      EXPECT_EQ(fast->train(one.training()).clipped, 1u);
      expect_sound(*fast, *c.model, one);
      for (int step = 0; step < 3500; ++step) {
        const double loss = fast->train(usual.training()).loss;
        if (step >= 3400) {
          EXPECT_LE(loss, 0.1) << c.name << " " << step;
        }
      }
      expect_sound(*fast, *c.model, one);
    }
  }
}

TEST(ExtremeTargets, OneBrightRecordDoesNotSetTheInitialAnswers) {
  const ModelCase c = find_model_case("nrc");
  OwnedBatch batch = make_batch(*c.model, 4096, 6);
  batch.targets[50] = 1e6f;
  TrainingOptions still;
  still.adam.learning_rate = 0.0f;
  for (const auto& fast : fast_backends(c.model, still)) {
    fast->train(batch.training());
    const std::vector<float> start = raw_answers(*fast, *c.model, batch, false);
    const auto [low, high] = std::minmax_element(start.begin(), start.end());
    EXPECT_GE(*low, 0.5f);
    EXPECT_LE(*high, 2.0f);
  }
}

}  // namespace
}  // namespace gatelight::neural
