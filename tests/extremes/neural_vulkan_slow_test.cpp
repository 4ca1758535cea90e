// Vulkan beside the reference at the same extremes.

#include "base/errors.h"
#include "neural/vulkan/vulkan_backend.h"
#include "tests/extremes/extreme.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using gatelight::testing::report_extreme;

/// Null where there is no device and GATELIGHT_REQUIRE_VULKAN is not set.
const std::shared_ptr<vulkan::Machine>& machine() {
  static const std::shared_ptr<vulkan::Machine> opened = []() -> std::shared_ptr<vulkan::Machine> {
    try {
      return vulkan::open_machine({});
    } catch (const Unavailable&) {
      if (std::getenv("GATELIGHT_REQUIRE_VULKAN") != nullptr) throw;
      return nullptr;
    }
  }();
  return opened;
}

Backends on_vulkan(const std::shared_ptr<const Model>& model, const TrainingOptions& options) {
  Backends backends;
  backends.push_back(vulkan::make_vulkan_backend(machine(), model, options));
  return backends;
}

class ExtremesOnVulkan : public ::testing::Test {
 protected:
  void SetUp() override {
    if (machine() == nullptr) GTEST_SKIP() << "no Vulkan device";
  }

  void expect_same(const std::string& where, const ModelCase& c, const TrainingOptions& options,
                   const ModelState& state, const OwnedBatch& batch, int steps = 1) {
    agreement.expect_same(where, c, options, state, batch, steps);
  }

  Agreement agreement{on_vulkan};
};

TEST_F(ExtremesOnVulkan, TargetsAgreeWithTheReference) {
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, 1, true);
    expect_same("one record", c, options, state, make_smooth_batch(*c.model, state, 1, 1, {}));
    expect_same("mixed", c, options, state, make_smooth_batch(*c.model, state, 509, 1, {.nonfinite = 0.5f}));
    OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 2, {});
    const auto set_all = [&](float value) {
      for (float& target : batch.targets)
        if (std::isfinite(target)) target = value;
    };
    set_all(0.0f);
    expect_same("zero", c, options, state, batch);
    set_all(7.0f);
    expect_same("equal", c, options, state, batch);
    batch.targets[c.model->config.mlp.outputs * 40] = 1e30f;
    options.adam.epsilon = options.max_target;
    expect_same("1e30", c, options, state, batch);
  }
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, 3, false);
  expect_same("one triangle", c, options, state,
              make_smooth_batch(*c.model, state, 2000, 3, {.crowded = 1.0f}));
  report_extreme("targets, on Vulkan",
                 "one record; all 0; all equal; one of 1e30; half NaN and infinity; one triangle",
                 agreement.text(), "");
}

TEST_F(ExtremesOnVulkan, TheInitialBiasMatchesTheReference) {
  const ModelCase c = find_model_case("nrc");
  OwnedBatch batch = make_batch(*c.model, 1000, 6);
  batch.targets[50] = 1e6f;
  for (std::size_t i = 0; i < batch.targets.size(); i += 7) batch.targets[i] = 0.0f;
  TrainingOptions still;
  still.adam.learning_rate = 0.0f;
  const auto reference = reference::make_reference_backend(c.model, still);
  const auto device = vulkan::make_vulkan_backend(machine(), c.model, still);
  reference->train(batch.training());
  device->train(batch.training());
  const LayerLayout& last = c.model->parameters.layers.back();
  const ModelState expected = reference->export_state(), got = device->export_state();
  double worst = 0;
  for (std::size_t o = 0; o < last.outputs; ++o) {
    const double bias = expected.parameters[last.biases + o];
    EXPECT_LE(bias, 2.0);
    worst = std::max(worst, std::abs(got.parameters[last.biases + o] / bias - 1));
  }
  EXPECT_LE(worst, 1e-5);
  report_extreme(
      "one target of 1e6 in the first batch, on Vulkan", "among 1000 records, a seventh of the others 0",
      fmt::format("the output's bias starts within {:.1e} of the reference's (bound 1e-5)", worst), "");
}

TEST_F(ExtremesOnVulkan, ModelsAgreeWithTheReference) {
  std::uint64_t seed = 10;
  const auto random_step = [&](const std::string& name, const ModelConfig& config) {
    const ModelCase c = make_case(name, config);
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, ++seed, true);
    expect_same(name, c, options, state,
                make_smooth_batch(*c.model, state, 149, seed, {.unstored = 0.1f, .border = 0.1f}));
  };
  for (const std::uint32_t resolution : {1u, 32u, 64u}) {
    ModelConfig config = default_gate_config();
    config.gate.stack = {resolution};
    config.gate.features = 1;
    random_step(fmt::format("R {}", resolution), config);
  }
  ModelConfig config = default_gate_config();
  config.gate.features = 16;
  config.gate.stack = {64, 32, 3, 1};
  random_step("L 16", config);
  config = default_hash_config();
  config.hash_grid.levels = 16;
  config.hash_grid.features = 1;
  config.hash_grid.growth = 1.4f;
  random_step("16 hash levels", config);
  report_extreme("models, on Vulkan", "R = 1, 32, 64; L = 1, 16; 1 and 4 levels; a hash grid of 16",
                 agreement.text(), "");
}

TEST_F(ExtremesOnVulkan, WeightsAndCountersAgreeWithTheReference) {
  const ModelCase c = find_model_case("nrc");
  const ParameterLayout& layout = c.model->parameters;
  TrainingOptions options = smooth_options();
  ModelState state = random_state(*c.model, options, 20, false);
  ModelState zero = state;
  std::fill(zero.parameters.begin(), zero.parameters.end(), 0.0f);
  zero.averages = zero.parameters;
  OwnedBatch batch = make_batch(*c.model, 96, 20);
  for (float& target : batch.targets) target += 5.0f;
  expect_same("zero", c, options, zero, batch);
  ModelState dead = state;
  for (std::size_t l = 0; l + 1 < layout.layers.size(); ++l)
    for (std::uint32_t o = 0; o < layout.layers[l].outputs; ++o)
      dead.parameters[layout.layers[l].biases + o] = -1e3f;
  dead.averages = dead.parameters;
  expect_same("dead", c, options, dead, batch);
  options.adam.learning_rate = 1000;  // because it decays with the steps
  for (const std::uint32_t counter : {0xfffffffdu, 0xffffffffu}) {
    ModelState late = random_state(*c.model, options, 21, true);
    late.node_steps.assign(late.node_steps.size(), counter);
    late.steps = counter;
    expect_same("counter", c, options, late, make_smooth_batch(*c.model, late, 70, 21, {}), 4);
  }
  report_extreme("weights and counters, on Vulkan",
                 "all zero; dead units; counters from 2^32 - 3 on, 4 steps", agreement.text(), "");
}

TEST_F(ExtremesOnVulkan, RatesAndFp16StayFinite) {
  const ModelCase c = find_model_case("nrc");
  for (const float rate : {0.0f, 1.0f, 1e3f}) {
    TrainingOptions options;
    options.adam.learning_rate = rate;
    options.precision = rate == 1.0f ? FeaturePrecision::fp16 : FeaturePrecision::fp32;
    const auto device = vulkan::make_vulkan_backend(machine(), c.model, options);
    const ModelState before = device->export_state();
    for (std::uint64_t step = 0; step < 30; ++step) device->train(make_batch(*c.model, 96, step).training());
    const ModelState after = device->export_state();
    EXPECT_TRUE(all_finite(after.parameters) && all_finite(after.averages) &&
                all_finite(after.first_moments) && all_finite(after.second_moments));
    if (rate == 0.0f) {
      const std::span features(before.parameters.data(), c.model->parameters.network);
      EXPECT_TRUE(std::equal(features.begin(), features.end(), after.parameters.begin()));
    }
  }
  report_extreme("learning rates, on Vulkan", "0, 1 with fp16 features, 1e3; 30 steps",
                 "finite; with 0 no feature changes", "");
}

}  // namespace
}  // namespace gatelight::neural
