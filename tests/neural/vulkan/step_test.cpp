// A training step of the Vulkan backend agrees with the reference.

#include "neural/vulkan/machine.h"
#include "neural/vulkan/step_scratch.h"
#include "tests/neural/agreement_loops.h"
#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanStep : public AgreesOnVulkan {};

TEST_F(VulkanStep, AgreesUnderEveryOption) {
  expect_same_step_under_options(agreement(), {"nrc", "gate_L5_per_triangle_stack_5_a_1", "hash_F3"},
                                 {Loss::relative_l2});
}

// Tiles have up to 64 records, blocks of the sort 2048 references, pieces 64.
TEST_F(VulkanStep, AgreesForManyBatchSizes) {
  for (const char* name : {"nrc", "hash_F4", "plain_with_everything"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    std::uint64_t seed = 20;
    for (const std::size_t size : {0u, 1u, 2u, 63u, 64u, 65u, 127u, 128u, 129u, 341u, 342u, 1021u}) {
      const ModelState state = random_state(*c.model, options, ++seed, false);
      const OwnedBatch batch = make_smooth_batch(*c.model, state, size, seed,
                                                 {.nonfinite = 0.05f, .unstored = 0.05f, .crowded = 0.7f});
      agreement().expect_same_step(name, c.model, options, batch, state);
    }
  }
}

TEST_F(VulkanStep, AgreesFor16384Records) {
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, 7, false);
    const OwnedBatch batch = make_smooth_batch(*c.model, state, 16384, 7,
                                               {.nonfinite = 0.01f, .unstored = 0.01f, .crowded = 0.1f});
    agreement().expect_same_step(c.name, c.model, options, batch, state);
  }
}

// Two and a half tiles for each workgroup.
TEST_F(VulkanStep, AgreesWhereTilesShareAWorkgroup) {
  const ModelCase c = find_model_case("mlp_5x128");
  const std::uint32_t tile = vulkan::training_tile(*c.model, test_machine()->device().limits().shared_bytes);
  const std::uint32_t groups = vulkan::cut_step(*c.model, std::uint64_t{1} << 24, tile).groups;
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, 8, false);
  const OwnedBatch batch =
      make_smooth_batch(*c.model, state, std::size_t{tile} * groups * 5 / 2, 8, {.nonfinite = 0.01f});
  agreement().expect_same_step(c.name, c.model, options, batch, state);
}

// Beyond the table of Adam's factors the shader computes them.
TEST_F(VulkanStep, AgreesAfterMoreStepsThanAreTabulated) {
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options = smooth_options();
  for (const float beta2 : {0.99f, 0.999999f}) {
    options.adam.beta2 = beta2;
    for (const std::uint64_t steps : {std::uint64_t{65535}, std::uint64_t{65536}, std::uint64_t{200000},
                                      std::uint64_t{1} << 32, (std::uint64_t{1} << 33) - 1}) {
      ModelState state = random_state(*c.model, options, 11, true);
      state.steps = steps;
      for (std::uint32_t& t : state.node_steps)
        t = static_cast<std::uint32_t>(std::min<std::uint64_t>(steps, ~0u));
      const OwnedBatch batch = make_smooth_batch(*c.model, state, 90, 11, {});
      agreement().expect_same_step(fmt::format("nrc after {} steps", steps), c.model, options, batch, state);
    }
  }
}

TEST_F(VulkanStep, TriangleCountersSaturate) {
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options = smooth_options();
  options.feature_step = FeatureStep::per_triangle;
  ModelState state = random_state(*c.model, options, 12, true);
  ASSERT_FALSE(state.triangle_steps.empty());
  for (std::size_t i = 0; i < state.triangle_steps.size(); ++i)
    state.triangle_steps[i] = ~0u - static_cast<std::uint32_t>(i % 2);
  const OwnedBatch batch = make_smooth_batch(*c.model, state, 90, 12, {});
  agreement().expect_same_step("nrc with full counters", c.model, options, batch, state);
}

TEST_F(VulkanStep, ABatchWithoutAnAcceptedRecordChangesNothing) {
  for (const char* name : {"nrc", "hash_F3"}) {
    const ModelCase c = find_model_case(name);
    for (const OptionsCase& o : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + o.name);
      const auto backend = vulkan::make_vulkan_backend(test_machine(), c.model, o.options);
      const ModelState before = backend->export_state();
      const OwnedBatch batch = make_batch(*c.model, 90, 3, {.nonfinite = 1.0f});
      const StepStatistics statistics = backend->train(batch.training());
      EXPECT_EQ(statistics.records, 0u);
      EXPECT_EQ(statistics.rejected, 90u);
      EXPECT_EQ(statistics.loss, 0.0);
      EXPECT_EQ(statistics.touched_nodes, 0u);
      EXPECT_EQ(backend->export_state(), before);
    }
  }
}

TEST_F(VulkanStep, InvalidBatchesAreRefused) {
  const ModelCase c = find_model_case("nrc");
  const auto backend = vulkan::make_vulkan_backend(test_machine(), c.model, {});
  OwnedBatch batch = make_batch(*c.model, 10, 1);
  batch.targets.pop_back();
  EXPECT_THROW(backend->train(batch.training()), BadConfiguration);
  std::vector<float> few(7);
  EXPECT_THROW(backend->query(batch.points(), {}, few), BadConfiguration);
  ModelState state = backend->export_state();
  state.averages.pop_back();
  EXPECT_THROW(backend->import_state(state), BadConfiguration);
}

}  // namespace
}  // namespace gatelight::neural
