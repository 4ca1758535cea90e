// No batch makes a weight NaN or infinite, or reads beyond an array.

#include <functional>

#include "tests/neural/extreme_batches.h"
#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanExtremes : public OnVulkan {};

void for_every_precision(const ModelCase& c, const std::function<void(Backend&)>& body) {
  for (const FeaturePrecision precision :
       {FeaturePrecision::fp32, FeaturePrecision::fp16_masters, FeaturePrecision::fp16}) {
    const TrainingOptions options{.precision = precision};
    SCOPED_TRACE(fmt::format("{} precision {}", c.name, static_cast<int>(precision)));
    body(*vulkan::make_vulkan_backend(test_machine(), c.model, options));
  }
}

TEST_F(VulkanExtremes, WeightsStayFiniteForEveryTarget) {
  for (const ModelCase& c : usual_cases())
    for_every_precision(c, [&](Backend& backend) {
      expect_finite_for_targets(backend, *c.model, {0.0f, 1e-45f, 1e-6f, 1e9f, kGreatestFloat});
    });
}

TEST_F(VulkanExtremes, WeightsStayFiniteForEveryInput) {
  for (const ModelCase& c : usual_cases())
    for_every_precision(c, [&](Backend& backend) {
      expect_finite_for_inputs(backend, *c.model, {1e-45f, 1e-38f, 1e19f, kGreatestFloat});
    });
}

TEST_F(VulkanExtremes, SurfacesAndTrianglesBeyondTheLayoutAreUnstored) {
  for (const char* name : {"nrc", "gate_L5_per_triangle", "gate_L8_cells_0"}) {
    const ModelCase c = find_model_case(name);
    const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, {});
    OwnedBatch batch = make_batch(*c.model, 64, 3);
    const auto surfaces = static_cast<std::uint32_t>(c.model->gate.surfaces.size());
    for (std::size_t r = 0; r < 64; r += 2) {
      if (r % 4 == 0)
        batch.surfaces[r] = r % 8 == 0 ? surfaces : ~0u;
      else
        batch.triangles[r] = r % 8 == 2 ? c.model->gate.surfaces[batch.surfaces[r]].triangle_count : ~0u;
    }
    const StepStatistics statistics = device->train(batch.training());
    EXPECT_EQ(statistics.unstored, 32u);
    EXPECT_EQ(statistics.records, 32u);
    expect_finite(*device, batch, *c.model);
  }
}

// If the outputs overflow, no gradient is finite.
TEST_F(VulkanExtremes, WeightsAndNodesWithoutAFiniteGradientAreNotChanged) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options{.start_at_mean = false};
  const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, options);
  const auto host = cpu::make_cpu_backend(c.model, options);
  ModelState state = initial_state(*c.model, options);
  for (std::uint64_t p = c.model->parameters.network; p < c.model->parameters.count; ++p)
    state.parameters[p] = 1e15f;
  state.averages = state.parameters;
  device->import_state(state);
  host->import_state(state);
  const OwnedBatch batch = make_batch(*c.model, 40, 6);
  const StepStatistics got = device->train(batch.training()), expected = host->train(batch.training());
  EXPECT_GT(got.skipped_updates, 0u);
  EXPECT_EQ(got.skipped_updates, expected.skipped_updates);
  expect_finite(*device, batch, *c.model);
}

}  // namespace
}  // namespace gatelight::neural
