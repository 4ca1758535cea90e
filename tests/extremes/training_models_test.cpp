// Training: extremes of the model: resolutions, feature vectors, weights.

#include "base/errors.h"
#include "base/half.h"
#include "tests/extremes/extreme.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using gatelight::testing::report_extreme;

/// Compares a step and answers of the model with the reference, with random weights and some bad records.
void expect_same(Agreement& agreement, const ModelCase& c, std::uint64_t seed) {
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, seed, true);
  const OwnedBatch batch =
      make_smooth_batch(*c.model, state, 149, seed, {.nonfinite = 0.05f, .unstored = 0.05f, .border = 0.1f});
  agreement.expect_same(c.name, c, options, state, batch);
}

TEST(ExtremeModels, ResolutionsOf1And32And64AgreeWithTheReference) {
  Agreement agreement;
  std::uint64_t seed = 0;
  std::uint32_t nodes = 0;
  for (const std::uint32_t resolution : {1u, 2u, 3u, 32u, 64u})
    for (const NodeStorage storage : {NodeStorage::shared, NodeStorage::per_triangle}) {
      ModelConfig config = default_gate_config();
      config.gate.rule = ResolutionRule::fixed;
      config.gate.fixed_resolution = resolution;
      config.gate.max_resolution = 64;
      config.gate.cluster = false;
      config.gate.storage = storage;
      config.gate.features = 2;
      config.gate.stack = {kAdaptive};
      const ModelCase c = make_case(fmt::format("R_{}", resolution), config);
      nodes = std::max(nodes, c.model->parameters.node_count);
      expect_same(agreement, c, ++seed);
    }
  ModelConfig config = default_gate_config();
  config.gate.rule = ResolutionRule::fixed;
  config.gate.fixed_resolution = 65;
  EXPECT_THROW(make_case("R_65", config), BadConfiguration);
  config.gate.fixed_resolution = 0;
  EXPECT_THROW(make_case("R_0", config), BadConfiguration);
  report_extreme("resolutions R",
                 fmt::format("1, 2, 3, 32, 64, shared and per triangle; up to {} nodes", nodes),
                 agreement.text(), "R = 0 and R = 65: BadConfiguration (exit code 1)");
}

TEST(ExtremeModels, FeatureVectorsOf1And16AndStacksOf1And4AgreeWithTheReference) {
  Agreement agreement;
  std::uint64_t seed = 20;
  for (const std::uint32_t features : {1u, 16u})
    for (const std::vector<std::uint32_t>& stack :
         std::vector<std::vector<std::uint32_t>>{{1}, {64}, {kAdaptive}, {64, 32, 3, 1}, {1, 1, 1, 1}}) {
      ModelConfig config = default_gate_config();
      config.gate.features = features;
      config.gate.stack = stack;
      expect_same(agreement, make_case(fmt::format("L_{}_levels_{}", features, stack.size()), config),
                  ++seed);
    }
  std::size_t refused = 0;
  for (const auto& [features, stack] :
       std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>>{{0, {1}},
                                                                         {17, {1}},
                                                                         {~0u, {1}},
                                                                         {8, {}},
                                                                         {8, {1, 1, 1, 1, 1}},
                                                                         {8, {65}},
                                                                         {8, {adaptive_part(65)}}}) {
    ModelConfig config = default_gate_config();
    config.gate.features = features;
    config.gate.stack = stack;
    EXPECT_THROW(make_case("refused", config), BadConfiguration);
    ++refused;
  }
  report_extreme("feature vectors of L numbers, levels", "L = 1 and 16, 1 and 4 levels, R from 1 to 64",
                 agreement.text(), fmt::format("{} beyond: BadConfiguration (exit code 1)", refused));
}

TEST(ExtremeModels, HashGridsOf1And16LevelsAgreeWithTheReference) {
  Agreement agreement;
  std::uint64_t seed = 40;
  for (const std::uint32_t levels : {1u, 16u})
    for (const std::uint32_t features : {1u, 16u})
      for (const std::uint32_t log2_size : {3u, 16u}) {
        if (levels * features > kMaxInputs - 36) continue;
        ModelConfig config = default_hash_config();
        config.hash_grid.levels = levels;
        config.hash_grid.features = features;
        config.hash_grid.log2_table_size = log2_size;
        config.hash_grid.growth = 1.4f;
        expect_same(agreement, make_case(fmt::format("hash_{}_{}_{}", levels, features, log2_size), config),
                    ++seed);
      }
  report_extreme("hash grids", "1 and 16 levels, 1 and 16 numbers, tables of 2^3 and 2^16", agreement.text(),
                 "");
}

TEST(ExtremeModels, NetworksOf16And128WithOneAndFiveLayersAgreeWithTheReference) {
  Agreement agreement;
  std::uint64_t seed = 60;
  for (const std::uint32_t width : {16u, 128u})
    for (const std::uint32_t layers : {1u, 5u})
      for (const std::uint32_t outputs : {1u, 16u}) {
        ModelConfig config = default_gate_config();
        config.mlp = {.width = width, .hidden_layers = layers, .outputs = outputs};
        expect_same(agreement, make_case(fmt::format("mlp_{}_{}_{}", width, layers, outputs), config),
                    ++seed);
      }
  report_extreme("networks", "16 and 128 wide, 1 and 5 hidden layers, 1 and 16 outputs", agreement.text(),
                 "");
}

/// A model over one small triangle.
ModelCase one_triangle(Sides sides, float spacing) {
  static const OwnedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  ModelConfig config = default_gate_config();
  config.gate.node_spacing = spacing;
  config.gate.stack = {kAdaptive};
  SurfaceLayout surfaces;
  surfaces.meshes = {{mesh.positions, mesh.triangles}};
  surfaces.instances = {{.mesh = 0, .sides = sides}};
  return {"one_triangle", make_model(config, surfaces)};
}

TEST(ExtremeModels, RecordsOfOneNodeAgreeWithTheReference) {
  const ModelCase c = one_triangle(Sides::front, 1e6f);
  EXPECT_EQ(c.model->parameters.node_count, 1u);
  Agreement agreement;
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, 70, true);
  agreement.expect_same("one node", c, options, state, make_smooth_batch(*c.model, state, 5000, 70, {}));
  report_extreme("one node", "5000 records on it", agreement.text(), "");
}

TEST(ExtremeModels, WithoutAStoredSurfaceAStepChangesNothing) {
  std::size_t tried = 0;
  for (const bool instances : {false, true}) {
    ModelConfig config = default_gate_config();
    SurfaceLayout surfaces;
    static const OwnedMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    if (instances) {
      surfaces.meshes = {{mesh.positions, mesh.triangles}};
      surfaces.instances = {{.mesh = 0, .sides = Sides::none}};
    }
    const ModelCase c{"none", make_model(config, surfaces)};
    EXPECT_EQ(c.model->parameters.node_count, 0u);
    OwnedBatch batch;
    for (std::uint32_t r = 0; r < 97; ++r) {
      batch.surfaces.push_back(r % 5 == 0 ? ~0u : r % 3);
      batch.triangles.push_back(r % 2);
      batch.barycentrics.push_back({0.25f, 0.5f});
      batch.directions.push_back({0, 0, 1});
      batch.targets.insert(batch.targets.end(), 3, 1.0f);
      batch.fates.push_back(Fate::unstored);
    }
    for (const auto& fast : fast_backends(c.model, {})) {
      const ModelState before = fast->export_state();
      const StepStatistics s = fast->train(batch.training());
      EXPECT_EQ(s.unstored, 97u);
      EXPECT_EQ(s.records, 0u);
      EXPECT_TRUE(fast->export_state() == before);
      EXPECT_TRUE(all_finite(raw_answers(*fast, *c.model, batch)));
      ++tried;
    }
  }
  EXPECT_GT(tried, 0u);
  report_extreme("nothing stored", "no instance, and one without sides",
                 "a step changes nothing, answers are finite", "all records counted as unstored");
}

TEST(ExtremeModels, Fp16FeaturesStayWithinTheirRange) {
  double worst = 0;
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (const FeaturePrecision precision : {FeaturePrecision::fp16_masters, FeaturePrecision::fp16}) {
      TrainingOptions options = smooth_options();
      options.precision = precision;
      options.adam.learning_rate = 1e6f;
      options.adam.epsilon = 1e3f;
      ModelState state = random_state(*c.model, options, 80, false);
      for (std::size_t i = 0; i < c.model->parameters.network; ++i)
        state.parameters[i] = state.averages[i] = i % 2 == 0 ? kMaxHalf : -kMaxHalf;
      const OwnedBatch batch = make_batch(*c.model, 97, 80);
      const auto reference = reference::make_reference_backend(c.model, options);
      reference->import_state(state);
      for (int step = 0; step < 10; ++step) reference->train(batch.training());
      for (const auto& fast : fast_backends(c.model, options)) {
        SCOPED_TRACE(fmt::format("{} {}", name, fast->name()));
        fast->import_state(state);
        for (int step = 0; step < 10; ++step) fast->train(batch.training());
        expect_sound(*fast, *c.model, batch);
        const ModelState after = fast->export_state();
        for (std::size_t i = 0; i < c.model->parameters.network; ++i)
          worst = std::max(worst, std::abs(static_cast<double>(after.parameters[i])));
        const std::vector<float> out = raw_answers(*fast, *c.model, batch);
        EXPECT_TRUE(all_finite(out));
      }
    }
  }
  EXPECT_EQ(worst, 65504.0);
  report_extreme("fp16 features at overflow", "all at +-65504, 10 steps of a rate of 1e6",
                 "features stay within 65504, answers finite", "");
}

TEST(ExtremeModels, SubnormalFp16FeaturesAreReadExactly) {
  double worst = 0;
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options;
  options.precision = FeaturePrecision::fp16;
  ModelState state = random_state(*c.model, options, 81, false);
  // The steps of fp16 from its least number up.
  for (std::size_t i = 0; i < c.model->parameters.network; ++i)
    state.parameters[i] = state.averages[i] = static_cast<float>(i % 2048) * 0x1p-24f;
  // Makes the features decide.
  for (std::size_t i = c.model->parameters.network; i < c.model->parameters.count; ++i)
    state.parameters[i] = state.averages[i] *= 100.0f;
  const OwnedBatch batch = make_batch(*c.model, 997, 81);
  const auto reference = reference::make_reference_backend(c.model, options);
  reference->import_state(state);
  const std::vector<float> expected = raw_answers(*reference, *c.model, batch);
  for (const auto& fast : fast_backends(c.model, options)) {
    fast->import_state(state);
    worst = std::max(worst, relative_difference(raw_answers(*fast, *c.model, batch), expected));
    EXPECT_EQ(fast->export_state().parameters, state.parameters) << fast->name();
  }
  EXPECT_LE(worst, 3e-5);
  report_extreme(
      "fp16 features below 6.1e-5", "every subnormal number of fp16",
      fmt::format("read exactly although denormals are flushed: answers off by {:.1e} (bound 3e-5)", worst),
      "");
}

TEST(ExtremeModels, WithAllWeightsZeroAnswersAreTheMeanTarget) {
  Agreement agreement;
  double worst = 0;
  for (const char* name : {"nrc", "nao", "hash_F4", "leaky_slope_0_percent"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    ModelState state = random_state(*c.model, options, 90, false);
    std::fill(state.parameters.begin(), state.parameters.end(), 0.0f);
    state.averages = state.parameters;
    OwnedBatch batch = make_batch(*c.model, 96, 90);
    agreement.expect_same("zero", c, options, state, batch);
    // Only the output's bias can be trained: it finds the mean.
    TrainingOptions plain;
    plain.loss = Loss::l2;
    plain.adam.learning_rate = 0.05f;
    const std::size_t outputs = c.model->config.mlp.outputs;
    std::vector<double> mean(outputs, 0.0);
    for (std::size_t i = 0; i < batch.targets.size(); ++i) mean[i % outputs] += batch.targets[i] / 96.0;
    const auto fast = cpu::make_cpu_backend(c.model, plain);
    fast->import_state(state);
    for (int step = 0; step < 600; ++step) fast->train(batch.training());
    const std::vector<float> out = raw_answers(*fast, *c.model, batch);
    for (std::size_t i = 0; i < out.size(); ++i)
      worst = std::max(worst, std::abs(out[i] - mean[i % outputs]));
    expect_sound(*fast, *c.model, batch);
  }
  EXPECT_LE(worst, 0.01);
  report_extreme(
      "all weights zero", "4 models, 600 steps",
      fmt::format("answers are the mean target to {:.1e} (bound 0.01); {}", worst, agreement.text()), "");
}

// Every hidden unit on its negative side for all records.
TEST(ExtremeModels, DeadUnitsAgreeWithTheReferenceAndStayFinite) {
  Agreement agreement;
  for (const char* name : {"nrc", "mlp_5x128", "leaky_slope_0_percent", "leaky_slope_30_percent"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    ModelState state = random_state(*c.model, options, 91, false);
    const ParameterLayout& layout = c.model->parameters;
    for (std::size_t l = 0; l + 1 < layout.layers.size(); ++l)
      for (std::uint32_t o = 0; o < layout.layers[l].outputs; ++o)
        state.parameters[layout.layers[l].biases + o] = -1e3f;
    state.averages = state.parameters;
    OwnedBatch batch = make_batch(*c.model, 96, 91);
    for (float& target : batch.targets) target += 5.0f;
    agreement.expect_same("dead", c, options, state, batch);
    for (const auto& fast : fast_backends(c.model, {})) {
      fast->import_state(state);
      for (int step = 0; step < 100; ++step) fast->train(batch.training());
      expect_sound(*fast, *c.model, batch);
    }
  }
  report_extreme("dead units", "all hidden biases -1000, slopes 0, 0.01 and 0.3, up to 5 x 128",
                 fmt::format("{}; finite after 100 steps", agreement.text()), "");
}

TEST(ExtremeModels, L2WithHugeWeightsAgreesWithTheReferenceAndStaysFinite) {
  Agreement agreement;
  for (const float weight : {1e3f, 1e4f}) {
    const ModelCase c = find_model_case("mlp_1x16");
    TrainingOptions options = smooth_options();
    options.loss = Loss::l2;  // relative, an answer near 0 among such numbers is only rounding
    options.adam.l2_network = 0.01f;
    options.adam.epsilon = weight * weight * weight;
    ModelState state = random_state(*c.model, options, 92, false);
    for (std::size_t i = c.model->parameters.network; i < c.model->parameters.count; ++i)
      state.parameters[i] = state.averages[i] *= weight;
    const OwnedBatch batch = make_smooth_batch(*c.model, state, 96, 92, {});
    agreement.expect_same(fmt::format("weights {}", weight), c, options, state, batch);
  }
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options;
  options.adam.l2_network = 1e30f;
  const OwnedBatch batch = make_batch(*c.model, 96, 92);
  for (const auto& fast : fast_backends(c.model, options)) {
    for (int step = 0; step < 50; ++step) fast->train(batch.training());
    expect_sound(*fast, *c.model, batch);
  }
  report_extreme("l2 with huge weights", "weights times 1e3 and 1e4; l2 of 1e30",
                 fmt::format("{}; finite after 50 steps", agreement.text()), "");
}

}  // namespace
}  // namespace gatelight::neural
