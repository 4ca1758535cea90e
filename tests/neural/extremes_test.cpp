// No batch makes a weight NaN or infinite, and rejected records change nothing.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/errors.h"
#include "tests/neural/extreme_batches.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using simd::Isa;

/// Calls `body` for every instruction set and every way to store features.
void for_every_backend(const ModelCase& c, const TrainingOptions& options,
                       const std::function<void(Backend&)>& body) {
  for (const Isa isa : simd::available_isas())
    for (const FeaturePrecision precision :
         {FeaturePrecision::fp32, FeaturePrecision::fp16_masters, FeaturePrecision::fp16}) {
      TrainingOptions with = options;
      with.precision = precision;
      SCOPED_TRACE(fmt::format("{} {} precision {}", c.name, isa_name(isa), static_cast<int>(precision)));
      const auto backend = cpu::make_cpu_backend(c.model, with, isa);
      body(*backend);
    }
}

TEST(Extremes, WeightsStayFiniteForEveryTarget) {
  for (const ModelCase& c : usual_cases())
    for (const Loss loss : {Loss::l2, Loss::relative_l2})
      for (const float limit : {1e9f, kGreatestFloat}) {
        SCOPED_TRACE(fmt::format("limit {} loss {}", limit, static_cast<int>(loss)));
        const TrainingOptions options{.loss = loss, .max_target = limit};
        for_every_backend(c, options, [&](Backend& backend) {
          expect_finite_for_targets(backend, *c.model,
                                    {0.0f, 1e-45f, 1e-30f, 1e-6f, 1e6f, 1e9f, 1e30f, kGreatestFloat});
        });
      }
}

TEST(Extremes, WeightsStayFiniteForEveryInput) {
  for (const ModelCase& c : usual_cases())
    for_every_backend(c, {}, [&](Backend& backend) {
      expect_finite_for_inputs(backend, *c.model, {0.0f, 1e-45f, 1e-38f, 1e9f, 1e19f, 1e30f, kGreatestFloat});
    });
}

TEST(Extremes, BadRecordsAtTheEndOfABatchLeaveTheSameBits) {
  for (const ModelCase& c : usual_cases()) {
    const OwnedBatch good = make_batch(*c.model, 777, 4, {.beyond = 0.05f});
    const OwnedBatch bad = make_batch(*c.model, 333, 5, {.nonfinite = 0.6f, .unstored = 0.4f});
    OwnedBatch both = good;
    const bool gate = c.model->config.encoding == FeatureEncoding::gate;
    const std::size_t outputs = c.model->config.mlp.outputs;
    for (std::size_t r = 0; r < bad.size(); ++r) {
      if (!gate && bad.fates[r] != Fate::rejected) continue;
      const auto append = [&](auto& to, const auto& from) {
        if (!from.empty()) to.push_back(from[r]);
      };
      append(both.surfaces, bad.surfaces);
      append(both.triangles, bad.triangles);
      append(both.barycentrics, bad.barycentrics);
      append(both.positions, bad.positions);
      append(both.directions, bad.directions);
      append(both.normals, bad.normals);
      append(both.albedos, bad.albedos);
      append(both.roughnesses, bad.roughnesses);
      for (std::size_t o = 0; o < outputs; ++o) both.targets.push_back(bad.targets[r * outputs + o]);
      both.fates.push_back(bad.fates[r]);
    }
    ASSERT_GT(both.size(), good.size() + 100);
    for_every_backend(c, {}, [&](Backend& backend) {
      const ModelState start = backend.export_state();
      for (int step = 0; step < 3; ++step) backend.train(good.training());
      const ModelState expected = backend.export_state();
      backend.import_state(start);
      for (int step = 0; step < 3; ++step) {
        const StepStatistics s = backend.train(both.training());
        EXPECT_EQ(s.records, good.size());
        EXPECT_EQ(s.rejected + s.unstored, both.size() - good.size());
      }
      EXPECT_TRUE(backend.export_state() == expected);
    });
  }
}

TEST(Extremes, ABatchWithoutAGoodRecordChangesNothing) {
  for (const ModelCase& c : usual_cases()) {
    const OwnedBatch bad = make_batch(*c.model, 100, 6, {.nonfinite = 1.0f});
    const OwnedBatch good = make_batch(*c.model, 100, 7);
    for_every_backend(c, {}, [&](Backend& backend) {
      for (const bool fresh : {true, false}) {
        if (!fresh) backend.train(good.training());
        const ModelState before = backend.export_state();
        for (const bool empty : {false, true}) {
          const StepStatistics s = backend.train(empty ? TrainingBatch{} : bad.training());
          EXPECT_EQ(s.records + s.touched_nodes, 0u);
          EXPECT_EQ(s.rejected, empty ? 0u : 100u);
          EXPECT_EQ(s.loss, 0.0);
          EXPECT_TRUE(backend.export_state() == before);
        }
      }
      backend.query({}, {}, {});
    });
  }
}

// Step counters at the end of the table of Adam's factors, far beyond it, and at their maximum.
TEST(Extremes, StepsBeyondTheTableOfAdamFactorsAgree) {
  const ModelCase c = find_model_case("nrc");
  for (const std::uint32_t counter : {65534u, 65535u, 65536u, 1000000000u, 0xfffffffdu, 0xffffffffu})
    for (OptionsCase& o : all_training_options(*c.model)) {
      if (o.options.precision != FeaturePrecision::fp32) continue;
      make_smooth(o.options.adam);
      o.options.adam.learning_rate = 1000;  // because it decays with the steps
      ModelState state = random_state(*c.model, o.options, 9, true);
      state.node_steps.assign(state.node_steps.size(), counter);
      state.triangle_steps.assign(state.triangle_steps.size(), counter);
      state.steps = std::uint64_t{counter} * 5;
      const OwnedBatch batch = make_smooth_batch(*c.model, state, 70, 9, {});
      const auto reference = reference::make_reference_backend(c.model, o.options);
      reference->import_state(state);
      for (int step = 0; step < 3; ++step) reference->train(batch.training());
      const ModelState expected = reference->export_state();
      for (const Isa isa : simd::available_isas()) {
        SCOPED_TRACE(fmt::format("{} {} after {} steps", o.name, isa_name(isa), counter));
        const auto fast = cpu::make_cpu_backend(c.model, o.options, isa);
        fast->import_state(state);
        for (int step = 0; step < 3; ++step) fast->train(batch.training());
        const ModelState got = fast->export_state();
        EXPECT_EQ(got.steps, expected.steps);
        EXPECT_EQ(got.node_steps, expected.node_steps);
        EXPECT_EQ(got.triangle_steps, expected.triangle_steps);
        const std::vector<bool> none(c.model->parameters.node_count, false);
        EXPECT_LE(tensor_difference(*c.model, got.parameters, expected.parameters, none), 1e-4);
        EXPECT_LE(tensor_difference(*c.model, got.averages, expected.averages, none), 1e-4);
      }
    }
}

// A gradient whose square overflows is left out: parameter, moments, average and counter stay.
TEST(Extremes, GradientsBeyondAllBoundsChangeNothing) {
  const ModelCase c = find_model_case("nrc");
  for (const FeatureUpdate update : {FeatureUpdate::sparse, FeatureUpdate::dense}) {
    TrainingOptions options{.loss = Loss::l2, .update = update, .max_target = kGreatestFloat};
    ModelState state = random_state(*c.model, options, 11, true);
    OwnedBatch batch = make_batch(*c.model, 50, 11);
    for (float& target : batch.targets) target = 1e36f;
    for_every_backend(c, options, [&](Backend& backend) {
      backend.import_state(state);
      ModelState before = backend.export_state();
      const StepStatistics s = backend.train(batch.training());
      EXPECT_EQ(s.records, 50u);
      // Nodes that the batch does not touch have no gradient and move on with dense updates.
      EXPECT_EQ(s.skipped_updates, s.touched_nodes + c.model->parameters.network_count());
      if (update == FeatureUpdate::dense) return;
      before.steps += 1;
      EXPECT_TRUE(backend.export_state() == before);
    });
  }
}

// Training does not produce such features, but a file may contain them.
TEST(Extremes, ImportedFeaturesBeyondFp16AreClamped) {
  const ModelCase c = find_model_case("nrc");
  const OwnedBatch batch = make_batch(*c.model, 100, 12);
  for_every_backend(c, {}, [&](Backend& backend) {
    ModelState state = backend.export_state();
    for (std::size_t i = 0; i < c.model->parameters.network; ++i)
      state.parameters[i] = state.averages[i] = i % 2 == 0 ? 1e6f : -1e6f;
    backend.import_state(state);
    backend.train(batch.training());
    expect_finite(backend, batch, *c.model);
  });
}

// Gradients so small that their squares vanish in single precision, with the default and the least epsilon.
TEST(Extremes, VanishingGradientsLeaveWeightsFinite) {
  const ModelCase c = find_model_case("nrc");
  for (const float epsilon : {1e-15f, 1e-30f}) {
    TrainingOptions options{.loss = Loss::l2, .start_at_mean = false};
    options.adam.l2_network = 0;
    options.adam.epsilon = epsilon;
    for_every_backend(c, options, [&](Backend& backend) {
      OwnedBatch batch = make_batch(*c.model, 50, 10);
      ModelState state = backend.export_state();
      std::fill(state.parameters.begin(), state.parameters.end(), 0.0f);
      state.averages = state.parameters;
      for (const float target : {1e-18f, 1e-20f, 1e-23f, 1e-30f, 1e-38f, 1e-45f, 0.0f}) {
        SCOPED_TRACE(fmt::format("target {} epsilon {}", target, epsilon));
        backend.import_state(state);
        std::fill(batch.targets.begin(), batch.targets.end(), target);
        for (int step = 0; step < 5; ++step) backend.train(batch.training());
        expect_finite(backend, batch, *c.model);
        if (epsilon < 1e-15f) continue;
        for (const float p : backend.export_state().parameters) EXPECT_LE(std::abs(p), 0.1f);
      }
    });
  }
}

TEST(Extremes, AnUnstoredRecordWithHugeInputsBlocksNoUpdate) {
  ModelConfig config = find_model_case("nrc").model->config;
  config.auxiliary = {{InputSource::albedo, InputEncoding::identity, 0},
                      {InputSource::normal, InputEncoding::identity, 0},
                      {InputSource::direction, InputEncoding::identity, 0}};
  const auto surfaces = make_small_surfaces();
  const ModelCase c{"huge_inputs", make_model(config, surfaces->layout())};
  // Whether its hidden values overflow depends on the weights.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TrainingOptions options{.seed = seed};
    for_every_backend(c, options, [&](Backend& backend) {
      OwnedBatch batch = make_batch(*c.model, 100, 1);
      batch.surfaces[40] = 0xffffffffu;
      batch.albedos[40] = batch.normals[40] =
          batch.directions[40] = {kGreatestFloat, -kGreatestFloat, kGreatestFloat};
      const StepStatistics statistics = backend.train(batch.training());
      EXPECT_EQ(statistics.unstored, 1u);
      EXPECT_EQ(statistics.skipped_updates, 0u);
    });
  }
}

TEST(Extremes, AnInvalidStateIsRefusedAndChangesNothing) {
  const ModelCase c = find_model_case("nrc");
  const auto backend = cpu::make_cpu_backend(c.model, {});
  const ModelState start = backend->export_state();
  const auto refused = [&](const std::function<void(ModelState&)>& spoil) {
    ModelState state = start;
    spoil(state);
    EXPECT_THROW(backend->import_state(state), BadConfiguration);
    EXPECT_TRUE(backend->export_state() == start);
  };
  refused([](ModelState& s) { s.parameters.front() = std::nanf(""); });
  refused([](ModelState& s) { s.averages.back() = HUGE_VALF; });
  refused([](ModelState& s) { s.first_moments[7] = -HUGE_VALF; });
  refused([](ModelState& s) { s.second_moments[7] = -1e-30f; });
  refused([](ModelState& s) { s.steps = ~std::uint64_t{0}; });
  refused([](ModelState& s) { s.parameters.pop_back(); });
  refused([](ModelState& s) { s.averages.push_back(0); });
  refused([](ModelState& s) { s.first_moments.clear(); });
  refused([](ModelState& s) { s.second_moments.pop_back(); });
  refused([](ModelState& s) { s.node_steps.clear(); });
  refused([](ModelState& s) { s.triangle_steps.push_back(1); });
}

TEST(Extremes, MoreAuxiliaryInputsThanKernelsHoldAreRefused) {
  ModelConfig config;
  config.encoding = FeatureEncoding::none;
  config.auxiliary.assign(kMaxAuxiliaryInputs, {InputSource::roughness, InputEncoding::identity, 0});
  EXPECT_NO_THROW(make_model(config));
  config.auxiliary.push_back(config.auxiliary.back());
  EXPECT_THROW(make_model(config), BadConfiguration);
}

}  // namespace
}  // namespace gatelight::neural
