// Training: extremes of the learning rate, of step counters and of the targets.

#include "base/errors.h"
#include "neural/learning/adam.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;

TEST(ExtremeRates, RateZeroChangesNoParameter) {
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (OptionsCase& o : all_training_options(*c.model)) {
      o.options.adam.learning_rate = 0.0f;
      o.options.start_at_mean = false;
      const OwnedBatch batch = make_batch(*c.model, 97, 1);
      for (const auto& fast : fast_backends(c.model, o.options)) {
        SCOPED_TRACE(fmt::format("{} {} {}", name, o.name, fast->name()));
        const ModelState before = fast->export_state();
        for (int step = 0; step < 20; ++step) fast->train(batch.training());
        const ModelState after = fast->export_state();
        EXPECT_EQ(after.parameters, before.parameters);
        EXPECT_EQ(after.averages, before.averages);
        EXPECT_EQ(after.steps, 20u);
        expect_finite(*fast, batch, *c.model);
      }
    }
  }
}

TEST(ExtremeRates, RateOf1e_8MovesParametersByAtMostItsBound) {
  FastAgreement agreement;
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    TrainingOptions options = smooth_options();
    options.adam.learning_rate = 1e-8f;
    const ModelState state = random_state(*c.model, options, 2, true);
    const OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 2, {});
    agreement.expect_same("1e-8", c, options, state, batch, 10);

    TrainingOptions plain;
    plain.adam.learning_rate = 1e-8f;
    plain.start_at_mean = false;
    for (const auto& fast : fast_backends(c.model, plain)) {
      const ModelState before = fast->export_state();
      for (int step = 0; step < 100; ++step) fast->train(batch.training());
      const ModelState after = fast->export_state();
      // A step moves by at most 2.4 rates (Cauchy-Schwarz over the moments), and rounds to half a last place.
      for (std::size_t i = 0; i < after.parameters.size(); ++i)
        EXPECT_NEAR(after.parameters[i], before.parameters[i], 100 * (2.4e-8 + 3e-8));
      EXPECT_NE(after.parameters, before.parameters);
      expect_finite(*fast, batch, *c.model);
    }
  }
}

// Nothing overflows, so that loss and answers show the divergence. The renderer watches them.
TEST(ExtremeRates, RatesOf1And1000StayFiniteAndShowTheDivergence) {
  for (const char* name : {"nrc", "nao", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (const float rate : {1.0f, 1e3f})
      for (const FeaturePrecision precision :
           {FeaturePrecision::fp32, FeaturePrecision::fp16_masters, FeaturePrecision::fp16}) {
        TrainingOptions options;
        options.adam.learning_rate = rate;
        options.precision = precision;
        for (const auto& fast : fast_backends(c.model, options)) {
          SCOPED_TRACE(fmt::format("{} rate {} {}", name, rate, fast->name()));
          double greatest = 0;
          for (std::uint64_t step = 0; step < 100; ++step) {
            const OwnedBatch batch = make_batch(*c.model, 96, 3 + step);
            fast->train(batch.training());
            if (step % 10 != 0) continue;
            for (const float a : raw_answers(*fast, *c.model, batch))
              greatest = std::max(greatest, std::abs(static_cast<double>(a)));
          }
          expect_finite(*fast, make_batch(*c.model, 96, 3), *c.model);
          if (rate == 1e3f) {
            EXPECT_GE(greatest, 100.0) << "targets are 2 at most";
          }
        }
      }
  }
}

TEST(ExtremeRates, DecayAndAverageStayPositiveFromTheFirstStepToTheLast) {
  AdamOptions adam;
  const AverageOptions average;
  EXPECT_EQ(learning_rate_at(adam, 1), adam.learning_rate);
  EXPECT_EQ(average_rate(average, 1), 1.0);
  double rate = 1, weight = 2;
  for (std::uint64_t t = 1; t < std::uint64_t{1} << 63; t *= 2) {
    const double now = learning_rate_at(adam, t);
    EXPECT_LT(now, rate);
    EXPECT_GT(now, 0.0);
    rate = now;
    EXPECT_LE(average_rate(average, t), weight);
    weight = average_rate(average, t);
    const AdamFactors factors = adam_factors(adam, t);
    EXPECT_TRUE(std::isfinite(factors.step) && factors.step > 0.0 && factors.epsilon > 0.0) << t;
  }
  EXPECT_NEAR(weight, 0.01, 1e-7);
  // The least and the greatest decay allowed.
  for (const float steps : {1e-38f, std::numeric_limits<float>::max()}) {
    adam.decay_steps = steps;
    for (const std::uint64_t t : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{1} << 62})
      EXPECT_TRUE(std::isfinite(learning_rate_at(adam, t)) && learning_rate_at(adam, t) >= 0.0);
  }
}

// A file with more steps is treated as damaged.
TEST(ExtremeRates, TheStepCountEndsAt2To63) {
  const ModelCase c = find_model_case("nrc");
  const auto fast = cpu::make_cpu_backend(c.model, {});
  ModelState state = fast->export_state();
  state.steps = (std::uint64_t{1} << 63) - 1;
  fast->import_state(state);
  fast->train(make_batch(*c.model, 50, 1).training());
  EXPECT_EQ(fast->export_state().steps, std::uint64_t{1} << 63);
  state.steps = std::uint64_t{1} << 63;
  EXPECT_THROW(fast->import_state(state), BadConfiguration);
}

std::vector<ModelCase> learned_cases() {
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
  for (const ModelCase& c : learned_cases()) {
    const OwnedBatch batch = make_batch(*c.model, 1, 9);
    const auto fast = cpu::make_cpu_backend(c.model, {});
    EXPECT_LE(error_after(*fast, *c.model, batch, 500), 1e-3) << c.name;
    expect_finite(*fast, batch, *c.model);
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
        expect_finite(*fast, batch, *c.model);
      }
    }
  }
  // 65 x 66 / 2 nodes of R = 64.
  EXPECT_LE(most, 2145u);
}

TEST(ExtremeTargets, EqualTargetsAreLearned) {
  FastAgreement agreement;
  for (const ModelCase& c : learned_cases())
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
      expect_finite(*fast, equal, *c.model);
    }
}

// Adam remembers the square of a gradient for as long as it is above the usual ones.
TEST(ExtremeTargets, OneTargetOf1e30IsClampedAndForgotten) {
  FastAgreement agreement;
  for (const ModelCase& c : learned_cases()) {
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
      expect_finite(*fast, one, *c.model);
      for (int step = 0; step < 3500; ++step) {
        const double loss = fast->train(usual.training()).loss;
        if (step >= 3400) {
          EXPECT_LE(loss, 0.1) << c.name << " " << step;
        }
      }
      expect_finite(*fast, one, *c.model);
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
