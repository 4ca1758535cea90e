// After many steps the Vulkan backend and the CPU's have nearly the same parameters: for every encoding and
// loss.

#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanLaterSteps : public OnVulkan {};

// Tolerances after a number of steps, relative to the greatest parameter in the same tensor. Rounding errors
// grow with each step, and a hidden unit at its kink may take the other side.
constexpr std::pair<int, double> kTolerances[] = {{1, 2e-5}, {10, 1e-4}, {100, 1e-3}};

TrainingOptions steady_options(Loss loss) {
  TrainingOptions options{.loss = loss};
  // These make the step a smooth function of the gradient. With the default epsilon a step follows the sign
  // of a gradient that is only rounding errors.
  options.adam.learning_rate = 0.01f;
  options.adam.epsilon = 1e-1f;
  return options;
}

void expect_same_parameters(const std::string& name, const std::shared_ptr<const Model>& model, Loss loss,
                            int last = 10) {
  const TrainingOptions options = steady_options(loss);
  const auto host = cpu::make_cpu_backend(model, options);
  const auto device = vulkan::make_vulkan_backend(test_machine(), model, options);
  const ModelState start = random_state(*model, options, 5, false);
  host->import_state(start);
  device->import_state(start);
  int made = 0;
  for (const auto& [steps, tolerance] : kTolerances) {
    if (steps > last) break;
    StepStatistics host_step, device_step;
    for (; made < steps; ++made) {
      const OwnedBatch batch = make_batch(*model, 256, 900 + static_cast<std::uint64_t>(made),
                                          {.nonfinite = 0.02f, .unstored = 0.02f});
      host_step = host->train(batch.training());
      device_step = device->train(batch.training());
    }
    const ModelState a = device->export_state(), b = host->export_state();
    const std::vector<bool> all(model->parameters.node_count, false);
    EXPECT_NEAR(device_step.loss, host_step.loss, tolerance * host_step.loss) << name << " after " << steps;
    EXPECT_LE(tensor_difference(*model, a.parameters, b.parameters, all), tolerance)
        << name << " after " << steps;
    EXPECT_LE(tensor_difference(*model, a.averages, b.averages, all), tolerance)
        << name << " after " << steps;
    EXPECT_EQ(a.steps, b.steps);
  }
}

TEST_F(VulkanLaterSteps, AgreeForEveryEncodingAndLoss) {
  for (const char* name : {"nrc", "nao", "gate_L5_per_triangle_stack_5_a_1", "gate_L8_cells_0", "hash_F4",
                           "plain_with_everything"})
    for (const Loss loss : {Loss::l2, Loss::relative_l2}) {
      const ModelCase c = find_model_case(name);
      expect_same_parameters(fmt::format("{} loss {}", name, static_cast<int>(loss)), c.model, loss);
    }
}

TEST_F(VulkanLaterSteps, AgreeInLongTraining) {
  for (const char* name : {"nrc", "hash_F4"})
    expect_same_parameters(name, find_model_case(name).model, Loss::relative_l2, 100);
}

}  // namespace
}  // namespace gatelight::neural
