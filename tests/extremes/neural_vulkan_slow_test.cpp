// Vulkan beside the reference at the same extremes.

#include "tests/extremes/fast_backends.h"
#include "tests/neural/vulkan/device.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class ExtremesOnVulkan : public OnVulkan {
 protected:
  FastAgreement agreement{[](const std::shared_ptr<const Model>& model, const TrainingOptions& options) {
    std::vector<NamedBackend> backends;
    backends.push_back({"vulkan", vulkan::make_vulkan_backend(test_machine(), model, options)});
    return backends;
  }};
};

TEST_F(ExtremesOnVulkan, TheInitialBiasMatchesTheReference) {
  const ModelCase c = find_model_case("nrc");
  OwnedBatch batch = make_batch(*c.model, 1000, 6);
  batch.targets[50] = 1e6f;
  for (std::size_t i = 0; i < batch.targets.size(); i += 7) batch.targets[i] = 0.0f;
  TrainingOptions still;
  still.adam.learning_rate = 0.0f;
  const auto reference = reference::make_reference_backend(c.model, still);
  const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, still);
  reference->train(batch.training());
  device->train(batch.training());
  const LayerLayout& last = c.model->parameters.layers.back();
  const ModelState expected = reference->export_state(), got = device->export_state();
  for (std::size_t o = 0; o < last.outputs; ++o) {
    const double bias = expected.parameters[last.biases + o];
    EXPECT_LE(bias, 2.0);
    EXPECT_NEAR(got.parameters[last.biases + o] / bias, 1.0, 1e-5);
  }
}

TEST_F(ExtremesOnVulkan, ZeroWeightsAndDeadUnitsAgreeWithTheReference) {
  const ModelCase c = find_model_case("nrc");
  const ParameterLayout& layout = c.model->parameters;
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, 20, false);
  ModelState zero = state;
  std::fill(zero.parameters.begin(), zero.parameters.end(), 0.0f);
  zero.averages = zero.parameters;
  OwnedBatch batch = make_batch(*c.model, 96, 20);
  for (float& target : batch.targets) target += 5.0f;
  agreement.expect_same("zero", c, options, zero, batch);
  ModelState dead = state;
  for (std::size_t l = 0; l + 1 < layout.layers.size(); ++l)
    for (std::uint32_t o = 0; o < layout.layers[l].outputs; ++o)
      dead.parameters[layout.layers[l].biases + o] = -1e3f;
  dead.averages = dead.parameters;
  agreement.expect_same("dead", c, options, dead, batch);
}

}  // namespace
}  // namespace gatelight::neural
