// No batch makes a weight NaN or infinite, or reads beyond an array.

#include <functional>

#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

constexpr float kGreatest = std::numeric_limits<float>::max();

class VulkanExtremes : public OnVulkan {};

void for_every_precision(const ModelCase& c, const std::function<void(Backend&)>& body) {
  for (const FeaturePrecision precision :
       {FeaturePrecision::fp32, FeaturePrecision::fp16_masters, FeaturePrecision::fp16}) {
    TrainingOptions options;
    options.precision = precision;
    SCOPED_TRACE(fmt::format("{} precision {}", c.name, static_cast<int>(precision)));
    body(*vulkan::make_vulkan_backend(test_machine(), c.model, options));
  }
}

std::vector<ModelCase> usual_cases() {
  return {find_model_case("nrc"), find_model_case("hash_with_everything"),
          find_model_case("plain_with_everything")};
}

void expect_finite(const Backend& backend, const OwnedBatch& batch, const Model& model) {
  const ModelState state = backend.export_state();
  const auto finite = [](const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
  };
  EXPECT_TRUE(finite(state.parameters) && finite(state.averages) && finite(state.first_moments) &&
              finite(state.second_moments));
  EXPECT_TRUE(finite(answers(backend, model, batch, {})));
}

TEST_F(VulkanExtremes, WeightsStayFiniteForEveryTarget) {
  for (const ModelCase& c : usual_cases())
    for_every_precision(c, [&](Backend& backend) {
      const ModelState start = backend.export_state();
      for (const float target : {0.0f, 1e-45f, 1e-6f, 1e9f, kGreatest}) {
        SCOPED_TRACE(target);
        backend.import_state(start);
        OwnedBatch batch = make_batch(*c.model, 50, 1);
        for (int step = 0; step < 4; ++step) {
          for (std::size_t i = 0; i < batch.targets.size(); ++i)
            batch.targets[i] = (step >= 2 ? i % 2 : static_cast<std::size_t>(step)) == 1 ? -target : target;
          EXPECT_EQ(backend.train(batch.training()).records, 50u);
        }
        expect_finite(backend, batch, *c.model);
      }
    });
}

TEST_F(VulkanExtremes, WeightsStayFiniteForEveryInput) {
  for (const ModelCase& c : usual_cases())
    for_every_precision(c, [&](Backend& backend) {
      const ModelState start = backend.export_state();
      for (const float value : {1e-45f, 1e-38f, 1e19f, kGreatest}) {
        SCOPED_TRACE(value);
        backend.import_state(start);
        OwnedBatch batch = make_batch(*c.model, 60, 2);
        for (std::size_t r = 0; r < batch.size(); ++r) {
          const auto set = [&](auto& span) {
            for (std::size_t i = 0; !span.empty() && i < span[r].size(); ++i)
              if (r % 3 != i) span[r][i] = r % 2 == 0 ? value : -value;
          };
          set(batch.barycentrics);
          set(batch.positions);
          set(batch.directions);
          set(batch.normals);
          set(batch.albedos);
          if (!batch.roughnesses.empty()) batch.roughnesses[r] = value;
        }
        for (int step = 0; step < 3; ++step) EXPECT_EQ(backend.train(batch.training()).rejected, 0u);
        expect_finite(backend, make_batch(*c.model, 60, 3), *c.model);
        expect_finite(backend, batch, *c.model);
      }
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
  TrainingOptions options;
  options.start_at_mean = false;
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
