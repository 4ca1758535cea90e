// Answers of the Vulkan backend agree with the reference.

#include <bit>

#include "neural/vulkan/answers.h"
#include "tests/neural/agreement_loops.h"
#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanAnswers : public AgreesOnVulkan {};

// The other models are in every_model_slow_test.cpp.
TEST_F(VulkanAnswers, AgreeForUsualModels) {
  std::uint64_t seed = 1;
  for (const char* name :
       {"nrc", "nao", "gate_L5_per_triangle_stack_5_a_1", "gate_L8_cells_0", "gate_L2_stack_64", "hash_F4",
        "hash_memory_target", "plain_with_everything", "mlp_5x128", "outputs_16"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    for (const std::size_t size : {1u, 63u, 64u, 65u, 130u})
      agreement().expect_same_answers(
          c, options,
          make_batch(*c.model, size, seed,
                     {.nonfinite = 0.1f, .unstored = 0.1f, .border = 0.3f, .crowded = 0}),
          state);
  }
}

// Inputs, one word per point, and weights; a thread computes at most one block of a layer's outputs.
TEST(VulkanAnswerTile, FitsTheSharedMemory) {
  std::vector<Model> models = {*find_model_case("nrc").model};
  models.front().parameters.inputs = 255;  // with the word per point, 2^k bytes
  for (const ModelCase& c : all_model_cases()) models.push_back(*c.model);
  for (const Model& model : models)
    for (const std::uint32_t bytes : {16384u, 32768u, 49152u, 65536u}) {
      const vulkan::AnswerTile tile = vulkan::answer_tile(model, bytes);
      const std::uint32_t width = model.config.mlp.width, columns = width < 32 ? 4 : 8;
      const std::uint32_t rows = std::max(model.parameters.inputs, width);
      EXPECT_TRUE(std::has_single_bit(tile.points) && tile.points >= 4) << tile.points;
      EXPECT_LE(tile.points / 4 * (width / columns), vulkan::kWorkgroupThreads);
      EXPECT_LE(4 * tile.points * (rows + 1) + 16 * tile.staged_vectors, bytes);
    }
  EXPECT_EQ(vulkan::answer_tile(*find_model_case("nrc").model, 49152).points, 128u);
  EXPECT_GT(vulkan::answer_tile(*find_model_case("nrc").model, 49152).staged_vectors, 1u);
  EXPECT_EQ(vulkan::answer_tile(*find_model_case("mlp_5x128").model, 49152).staged_vectors, 1u);
}

// Directions whose angle is 0 / 0, and barycentrics that are on a node or huge.
TEST_F(VulkanAnswers, AgreeAtPolesCornersAndFarOutside) {
  constexpr std::array<std::array<float, 3>, 7> kDirections = {
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, 0, 0}}};
  constexpr float kBelowOne = 0x1.fffffep-1f;
  constexpr std::array<std::array<float, 2>, 8> kBarycentrics = {{{0, 0},
                                                                  {1, 0},
                                                                  {0, 1},
                                                                  {1.0f / 3, 1.0f / 3},
                                                                  {kBelowOne / 3, kBelowOne / 3},
                                                                  {0x1.555556p-2f, 0x1.555556p-2f},
                                                                  {1e20f, 1e23f},
                                                                  {-1e20f, 1e23f}}};
  for (const char* name : {"nrc", "gate_L5_per_triangle_stack_5_a_1", "plain_with_everything"}) {
    const ModelCase c = find_model_case(name);
    OwnedBatch batch = make_batch(*c.model, 7 * 8 * 5, 9);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!batch.directions.empty()) batch.directions[i] = kDirections[i % 7];
      if (!batch.normals.empty()) batch.normals[i] = kDirections[(i + 3) % 7];
      if (!batch.barycentrics.empty()) batch.barycentrics[i] = kBarycentrics[i / 7 % 8];
    }
    agreement().expect_same_answers(c, {}, batch, random_state(*c.model, {}, 9, true));
  }
}

// A query is split into chunks of 2^17 points.
TEST_F(VulkanAnswers, AgreeForMorePointsThanAChunk) {
  const ModelCase c = find_model_case("nao");
  const TrainingOptions options;
  const ModelState state = random_state(*c.model, options, 5, true);
  const OwnedBatch batch = make_batch(*c.model, 600001, 5, {.nonfinite = 0.01f, .unstored = 0.01f});
  const auto host = cpu::make_cpu_backend(c.model, options);
  const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, options);
  host->import_state(state);
  device->import_state(state);
  const QueryOptions raw{QueryPrecision::fp32, OutputRange::raw, true};
  EXPECT_LE(relative_difference(answers(*device, *c.model, batch, raw), answers(*host, *c.model, batch, raw)),
            kTolerance);
}

TEST_F(VulkanAnswers, AgreeInBf16) {
  std::uint64_t seed = 600;
  for (const char* name : {"nrc", "nao", "hash_F4", "gate_with_everything", "mlp_5x128", "outputs_16"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    const OwnedBatch batch = make_batch(*c.model, 197, seed, {.nonfinite = 0.1f, .unstored = 0.1f});
    const auto reference = reference::make_reference_backend(c.model, options);
    const auto host = cpu::make_cpu_backend(c.model, options, simd::Isa::scalar);
    const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, options);
    for (Backend* backend : {reference.get(), host.get(), device.get()}) backend->import_state(state);
    for (const bool averaged : {false, true}) {
      SCOPED_TRACE(fmt::format("{}{}", name, averaged ? " averaged" : ""));
      const QueryOptions bf16{QueryPrecision::bf16, OutputRange::raw, averaged};
      const QueryOptions fp32{QueryPrecision::fp32, OutputRange::raw, averaged};
      const std::vector<float> got = answers(*device, *c.model, batch, bf16);
      EXPECT_LE(relative_difference(got, answers(*reference, *c.model, batch, bf16)), kBf16Tolerance);
      // The same numbers are rounded; a sum's last bit may round one of them the other way.
      EXPECT_LE(relative_difference(got, answers(*host, *c.model, batch, bf16)), 0.3 * kBf16Tolerance);
      EXPECT_NE(got, answers(*device, *c.model, batch, fp32)) << "bf16 is to round";
    }
  }
}

TEST_F(VulkanAnswers, AreClampedToTheRange) {
  expect_clamped_answers(*vulkan::make_vulkan_backend(test_machine(), find_model_case("nrc").model, {}),
                         QueryPrecision::fp32);
}

// Steps, averages and rounding change the parameters that are packed for queries.
TEST_F(VulkanAnswers, AreUpToDateAfterEachStep) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options;
  const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, options);
  const OwnedBatch batch = make_batch(*c.model, 120, 4);
  for (int step = 0; step < 3; ++step) {
    device->train(batch.training());
    const auto fresh = vulkan::make_vulkan_backend(test_machine(), c.model, options);
    fresh->import_state(device->export_state());
    for (const QueryPrecision precision : {QueryPrecision::fp32, QueryPrecision::bf16})
      for (const bool averaged : {true, false}) {
        const QueryOptions ask{precision, OutputRange::raw, averaged};
        EXPECT_EQ(answers(*device, *c.model, batch, ask), answers(*fresh, *c.model, batch, ask))
            << "step " << step << (averaged ? " averaged" : "");
      }
  }
}

}  // namespace
}  // namespace gatelight::neural
