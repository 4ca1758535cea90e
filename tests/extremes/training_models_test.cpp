// Training: extremes of a model's features and weights.

#include "base/half.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;

TEST(ExtremeModels, WithoutAStoredSurfaceAStepChangesNothing) {
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
    }
  }
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
      for (const auto& fast : fast_backends(c.model, options)) {
        SCOPED_TRACE(fmt::format("{} {}", name, fast->name()));
        fast->import_state(state);
        for (int step = 0; step < 10; ++step) fast->train(batch.training());
        expect_finite(*fast, batch, *c.model);
        const ModelState after = fast->export_state();
        for (std::size_t i = 0; i < c.model->parameters.network; ++i)
          worst = std::max(worst, std::abs(static_cast<double>(after.parameters[i])));
        EXPECT_TRUE(all_finite(raw_answers(*fast, *c.model, batch)));
      }
    }
  }
  EXPECT_EQ(worst, 65504.0);
}

TEST(ExtremeModels, SubnormalFp16FeaturesAreReadExactly) {
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
  EXPECT_LE(worst_answers(c, options, state, batch), kTolerance);
  for (const auto& fast : fast_backends(c.model, options)) {
    fast->import_state(state);
    EXPECT_EQ(fast->export_state().parameters, state.parameters) << fast->name();
  }
}

TEST(ExtremeModels, WithAllWeightsZeroAnswersAreTheMeanTarget) {
  FastAgreement agreement;
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
    for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], mean[i % outputs], 0.01) << name;
    expect_finite(*fast, batch, *c.model);
  }
}

// Every hidden unit on its negative side for all records.
TEST(ExtremeModels, DeadUnitsAgreeWithTheReferenceAndStayFinite) {
  FastAgreement agreement;
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
      expect_finite(*fast, batch, *c.model);
    }
  }
}

TEST(ExtremeModels, L2WithHugeWeightsAgreesWithTheReferenceAndStaysFinite) {
  FastAgreement agreement;
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
    expect_finite(*fast, batch, *c.model);
  }
}

}  // namespace
}  // namespace gatelight::neural
