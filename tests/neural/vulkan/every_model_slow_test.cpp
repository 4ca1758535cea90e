// Answers and a step of every kind of model agree with the reference. The test is slow on a software device,
// which compiles two pipelines for each shape of a network.

#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanEveryModel : public AgreesOnVulkan {};

// Tiles hold up to 64 points.
constexpr std::size_t kSizes[] = {1, 63, 64, 65, 97, 130, 7};

void set_gate(GateOptions& gate, std::size_t i) {
  const std::vector<std::vector<std::uint32_t>> stacks = {{kAdaptive, 1},
                                                          {kAdaptive},
                                                          {1},
                                                          {3},
                                                          {kAdaptive, 2},
                                                          {4, 2, 1},
                                                          {kAdaptive, 4, 2, 1},
                                                          {kAdaptive, adaptive_part(4), adaptive_part(16)},
                                                          {adaptive_part(3), 1, kAdaptive, adaptive_part(64)},
                                                          {adaptive_part(64), 3},
                                                          {kMaxResolution}};
  gate.stack = stacks[i % stacks.size()];
  gate.cluster = i < stacks.size();
  if (i == 12) gate.storage = NodeStorage::per_triangle;
  if (i == 13) gate.rule = ResolutionRule::paper;
  if (i == 14) gate.rule = ResolutionRule::fixed;
}

void set_hash_grid(HashGridOptions& grid, std::size_t i) {
  constexpr std::uint32_t kLevels[] = {8, 1, 2, 5, 16};
  grid.levels = kLevels[i % 5];
  grid.base_resolution = 3;
  grid.growth = 1.4f;
  if (i % 2 == 1) grid.memory_target = 100000;  // a table size that is no power of two
}

/// Number `i` of 32 models, whose values have coprime periods. Between them they have each value of a
/// shader's constants, and each pair of values that a shader uses together: features with the encoding
/// (`encode`), the width with the depth, and both with biases (offsets of layers), outputs with biases and
/// with the loss. All rests of inputs by four and of feature inputs by eight occur, inputs below and above
/// each width, and each size of tiles. The other values are data: `shaders_test` encodes all models with few
/// pipelines, and the kernels' parity test (`cpu`) has the reference's answers to all.
ModelCase combined_model(std::size_t i) {
  constexpr InputSource kSources[] = {InputSource::position, InputSource::direction, InputSource::normal,
                                      InputSource::albedo, InputSource::roughness};
  constexpr InputEncoding kEncodings[] = {InputEncoding::identity, InputEncoding::one_blob,
                                          InputEncoding::one_blob};
  constexpr float kSlopes[] = {0.0f, 0.2f, 1.0f};
  const auto n = static_cast<std::uint32_t>(i);
  const bool is_gate = i < 16;
  ModelConfig config = is_gate ? default_gate_config() : default_hash_config();
  config.gate.features = config.hash_grid.features = n % 16 + 1;
  if (is_gate) set_gate(config.gate, i);
  if (!is_gate) set_hash_grid(config.hash_grid, i);
  const std::uint32_t sizes[] = {0, 2u << n % 4, 2u << n / 3 % 5};
  config.auxiliary = {{kSources[i % 5], kEncodings[i % 3], sizes[i % 3]}};
  config.mlp.width = 16u << n % 4;
  config.mlp.hidden_layers = 1 + n % 5;
  config.mlp.outputs = 1 + (n + n / 4) % 16;
  config.mlp.biases = n / 4 % 2 == 0;
  config.mlp.leaky_slope = kSlopes[i % 3];
  return make_case(fmt::format("{}_L{}_mlp_{}x{}_outputs_{}", is_gate ? "gate" : "hash", n % 16 + 1,
                               config.mlp.hidden_layers, config.mlp.width, config.mlp.outputs),
                   config);
}

std::vector<ModelCase> covering_models() {
  std::vector<ModelCase> models;
  for (std::size_t i = 0; i < 32; ++i) models.push_back(combined_model(i));
  for (const char* name : {"plain_256_inputs", "plain_position_identity", "gate_only", "hash_tables_of_8"})
    models.push_back(find_model_case(name));
  return models;
}

TEST_F(VulkanEveryModel, AnswersAgree) {
  std::uint64_t seed = 1;
  for (const ModelCase& c : covering_models()) {
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    const OwnedBatch batch = make_batch(*c.model, kSizes[seed % std::size(kSizes)], seed,
                                        {.nonfinite = 0.1f, .unstored = 0.1f, .border = 0.3f, .crowded = 0});
    agreement().expect_same_answers(c, options, batch, state);
  }
}

TEST_F(VulkanEveryModel, AStepAgrees) {
  std::uint64_t seed = 100;
  for (const ModelCase& c : covering_models()) {
    TrainingOptions options = smooth_options();
    // Without biases some luminance is near 0, where the relative loss magnifies rounding errors.
    if (!c.model->config.mlp.biases) options.loss = Loss::l2;
    const ModelState state = random_state(*c.model, options, ++seed, false);
    const OwnedBatch batch =
        make_smooth_batch(*c.model, state, 60 + seed % 41, seed, {.nonfinite = 0.1f, .unstored = 0.1f});
    agreement().expect_same_step(c.name, c.model, options, batch, state);
  }
}

}  // namespace
}  // namespace gatelight::neural
