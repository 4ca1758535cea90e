// Training: extremes of the learning rate and of step counters.

#include "base/errors.h"
#include "neural/learning/adam.h"
#include "tests/extremes/extreme.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using gatelight::testing::report_extreme;

TEST(ExtremeRates, RateZeroChangesNoParameter) {
  std::size_t tried = 0;
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
        expect_sound(*fast, *c.model, batch);
        ++tried;
      }
    }
  }
  report_extreme("learning rate 0", fmt::format("20 steps, {} models, options and instruction sets", tried),
                 "no bit of parameters and averages changes", "");
}

TEST(ExtremeRates, RateOf1e_8MovesParametersByAtMostItsBound) {
  Agreement agreement;
  double worst = 0;
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
      for (std::size_t i = 0; i < after.parameters.size(); ++i) {
        const double moved = std::abs(static_cast<double>(after.parameters[i]) - before.parameters[i]);
        // A step moves by at most 2.4 rates (Cauchy-Schwarz over the moments), and rounds to half a last
        // place.
        worst = std::max(worst, moved / 100);
      }
      EXPECT_NE(after.parameters, before.parameters);
      expect_sound(*fast, *c.model, batch);
    }
  }
  EXPECT_LE(worst, 2.4e-8 + 3e-8);
  report_extreme(
      "learning rate 1e-8", "100 steps",
      fmt::format("{}; a step moves by at most {:.1e} (bound 5.4e-8: 2.4 rates and half a last place)",
                  agreement.text(), worst),
      "");
}

// Nothing overflows, so that loss and answers show the divergence. The renderer watches them.
TEST(ExtremeRates, RatesOf1And1000StayFiniteAndShowTheDivergence) {
  double least = 1e30;
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
          expect_sound(*fast, *c.model, make_batch(*c.model, 96, 3));
          if (rate == 1e3f) least = std::min(least, greatest);
        }
      }
  }
  EXPECT_GE(least, 100.0);
  report_extreme(
      "learning rates 1 and 1e3", "100 steps, three precisions of features",
      fmt::format(
          "state and answers finite; with 1e3 answers reach {:.1e} (targets are 2 at most; bound 100), "
          "which shows the divergence",
          least),
      "");
}

TEST(ExtremeRates, InvalidOptionsAreRefused) {
  const ModelCase c = find_model_case("nrc");
  std::size_t tried = 0;
  const auto refused = [&](auto change) {
    TrainingOptions options;
    change(options);
    EXPECT_THROW(cpu::make_cpu_backend(c.model, options), BadConfiguration);
    EXPECT_THROW(reference::make_reference_backend(c.model, options), BadConfiguration);
    ++tried;
  };
  for (const float bad : {-1e-8f, std::nanf(""), HUGE_VALF}) {
    refused([&](TrainingOptions& o) { o.adam.learning_rate = bad; });
    refused([&](TrainingOptions& o) { o.adam.decay_steps = bad; });
    refused([&](TrainingOptions& o) { o.adam.l2_network = bad; });
    refused([&](TrainingOptions& o) { o.adam.epsilon = bad; });
    refused([&](TrainingOptions& o) { o.average.ramp = bad; });
    refused([&](TrainingOptions& o) { o.max_target = bad; });
  }
  for (const float bad : {0.0f, 1e-31f, 1e-45f}) refused([&](TrainingOptions& o) { o.adam.epsilon = bad; });
  for (const float bad : {-0.1f, 1.0f, std::nanf("")}) {
    refused([&](TrainingOptions& o) { o.adam.beta1 = bad; });
    refused([&](TrainingOptions& o) { o.adam.beta2 = bad; });
    refused([&](TrainingOptions& o) { o.average.decay = bad; });
  }
  report_extreme("options that are not numbers or out of range", fmt::format("{} of them", tried), "",
                 "BadConfiguration that names option, value and range (exit code 1)");
}

// With the least epsilon allowed and gradients that are exactly 0: 0 / (0 + epsilon) is 0.
TEST(ExtremeRates, AZeroGradientMovesNoParameter) {
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options;
  options.adam.epsilon = 1e-30f;
  options.adam.l2_network = 0.0f;
  options.start_at_mean = false;
  for (const FeatureUpdate update : {FeatureUpdate::sparse, FeatureUpdate::dense}) {
    options.update = update;
    for (const auto& fast : fast_backends(c.model, options)) {
      ModelState state = fast->export_state();
      std::fill(state.parameters.begin(), state.parameters.end(), 0.0f);
      state.averages = state.parameters;
      fast->import_state(state);
      OwnedBatch batch = make_batch(*c.model, 96, 4);
      std::fill(batch.targets.begin(), batch.targets.end(), 0.0f);
      for (int step = 0; step < 50; ++step) fast->train(batch.training());
      EXPECT_EQ(fast->export_state().parameters, state.parameters) << fast->name();
      expect_sound(*fast, *c.model, batch);
    }
  }
  report_extreme("epsilon 1e-30 and no gradient", "50 steps from zero to zero", "no parameter moves", "");
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
  report_extreme("decay of the rate and ramp of the average", "steps 1 to 2^62",
                 fmt::format("falling and positive; at 2^62 the rate is {:.1e}, an average moves by {:.2g}",
                             rate, weight),
                 "");
}

TEST(ExtremeRates, CountersNear2To32Saturate) {
  Agreement agreement;
  for (const char* name : {"nrc", "gate_L5_per_triangle_stack_5_a_1", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (const std::uint32_t counter : {0xfffffffdu, 0xfffffffeu, 0xffffffffu})
      for (const FeatureStep step : {FeatureStep::per_node, FeatureStep::per_triangle}) {
        TrainingOptions options = smooth_options();
        options.adam.learning_rate = 1000;  // because it decays with the steps
        const bool gate = c.model->config.encoding == FeatureEncoding::gate;
        if (step == FeatureStep::per_triangle && !gate) continue;
        options.feature_step = step;
        options.count_triangles = gate;
        ModelState state = random_state(*c.model, options, 9, true);
        state.node_steps.assign(state.node_steps.size(), counter);
        state.triangle_steps.assign(state.triangle_steps.size(), counter);
        state.steps = counter;
        const OwnedBatch batch = make_smooth_batch(*c.model, state, 70, 9, {});
        agreement.expect_same(fmt::format("counter {}", counter), c, options, state, batch, 4);
        for (const auto& fast : fast_backends(c.model, options)) {
          fast->import_state(state);
          for (int s = 0; s < 4; ++s) fast->train(batch.training());
          const ModelState after = fast->export_state();
          EXPECT_EQ(after.steps, std::uint64_t{counter} + 4);
          EXPECT_EQ(*std::max_element(after.node_steps.begin(), after.node_steps.end()), 0xffffffffu);
          EXPECT_TRUE(std::all_of(after.node_steps.begin(), after.node_steps.end(),
                                  [&](std::uint32_t n) { return n >= counter; }));
        }
      }
  }
  // The step count itself ends at 2^63. A file with a greater one is treated as damaged.
  const ModelCase c = find_model_case("nrc");
  const auto fast = cpu::make_cpu_backend(c.model, {});
  ModelState state = fast->export_state();
  state.steps = (std::uint64_t{1} << 63) - 1;
  fast->import_state(state);
  fast->train(make_batch(*c.model, 50, 1).training());
  EXPECT_EQ(fast->export_state().steps, std::uint64_t{1} << 63);
  state.steps = std::uint64_t{1} << 63;
  EXPECT_THROW(fast->import_state(state), BadConfiguration);
  report_extreme("step counters near 2^32", "2^32 - 3 to 2^32 - 1, then 4 steps",
                 fmt::format("those of nodes and triangles stay at 2^32 - 1, the network's 64 bits go on; {}",
                             agreement.text()),
                 "states of 2^63 steps and more (BadConfiguration; in a file exit code 2)");
}

}  // namespace
}  // namespace gatelight::neural
