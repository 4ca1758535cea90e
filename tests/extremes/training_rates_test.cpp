// Training: extremes of the learning rate and of step counters.

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
        expect_sound(*fast, *c.model, batch);
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
      expect_sound(*fast, *c.model, batch);
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
          expect_sound(*fast, *c.model, make_batch(*c.model, 96, 3));
          if (rate == 1e3f) {
            EXPECT_GE(greatest, 100.0) << "targets are 2 at most";
          }
        }
      }
  }
}

TEST(ExtremeRates, InvalidOptionsAreRefused) {
  const ModelCase c = find_model_case("nrc");
  const auto refused = [&](auto change) {
    TrainingOptions options;
    change(options);
    EXPECT_THROW(cpu::make_cpu_backend(c.model, options), BadConfiguration);
    EXPECT_THROW(reference::make_reference_backend(c.model, options), BadConfiguration);
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

}  // namespace
}  // namespace gatelight::neural
