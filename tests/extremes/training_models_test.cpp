// Training: extremes of a model's features and weights. Denormal floats: flushed by every thread that
// computes, whatever its control word was.

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "base/half.h"
#include "base/platform/flush_denormals.h"
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

/// Sets the control word of this thread and restores the old one.
class ControlWord {
 public:
  explicit ControlWord(bool flushing) : before_(float_control()) {
    set_float_control(flushing ? before_ | kFlushBits : before_ & ~kFlushBits);
  }
  ~ControlWord() { set_float_control(before_); }

 private:
  std::uint64_t before_;
};

bool is_denormal(float x) {
  std::uint32_t word;
  std::memcpy(&word, &x, sizeof word);
  return (word & 0x7f800000u) == 0 && (word & 0x007fffffu) != 0;
}

std::size_t denormals_in(std::span<const float> values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), is_denormal));
}

/// Runs `f` in an arena of `threads` threads, made by a thread that flushes denormals or does not.
template <class F>
void in_arena(int threads, bool flushing, const F& f) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  const ControlWord word(flushing);
  tbb::task_arena(threads).execute(f);
}

/// Weights and targets so small that activations and gradients would be denormal.
ModelState tiny_state(const Model& model, const TrainingOptions& options) {
  ModelState state = random_state(model, options, 1, false);
  for (float& p : state.parameters) p *= 1e-19f;
  state.averages = state.parameters;
  return state;
}

TEST(Denormals, TheControlWordIsRestored) {
  for (const bool flushing : {false, true}) {
    const ControlWord word(flushing);
    const std::uint64_t before = float_control() & kFlushBits;
    {
      const FlushDenormals flush;
      EXPECT_EQ(float_control() & kFlushBits, kFlushBits);
      volatile float least = std::numeric_limits<float>::min();
      EXPECT_EQ(least / 2, 0.0f);
    }
    EXPECT_EQ(float_control() & kFlushBits, before);
    const ModelCase c = find_model_case("nrc");
    const auto backend = cpu::make_cpu_backend(c.model, {});
    const OwnedBatch batch = make_batch(*c.model, 3000, 1);
    backend->train(batch.training());
    raw_answers(*backend, *c.model, batch);
    EXPECT_EQ(float_control() & kFlushBits, before);
  }
}

TEST(Denormals, StepsAndAnswersHaveTheSameBitsForAnyModeOfTheThreads) {
  std::size_t made = 0;
  for (const char* name : {"nrc", "nao", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (const FeaturePrecision precision : {FeaturePrecision::fp32, FeaturePrecision::fp16}) {
      TrainingOptions options;
      options.loss = Loss::l2;
      options.precision = precision;
      options.start_at_mean = false;
      options.adam.l2_network = 0;
      const ModelState start = tiny_state(*c.model, options);
      OwnedBatch batch = make_batch(*c.model, 3001, 1, {.border = 0.3f});
      for (float& target : batch.targets) target *= 1e-38f;
      for (const simd::Isa isa : simd::available_isas()) {
        ModelState expected;
        std::vector<float> answers;
        for (const int threads : {1, 2, 7})
          for (const bool flushing : {true, false}) {
            SCOPED_TRACE(fmt::format("{} {} {} threads, {}", name, isa_name(isa), threads, flushing));
            ModelState got;
            std::vector<float> out;
            in_arena(threads, flushing, [&] {
              const auto backend = cpu::make_cpu_backend(c.model, options, isa);
              backend->import_state(start);
              for (int step = 0; step < 4; ++step) backend->train(batch.training());
              got = backend->export_state();
              out = raw_answers(*backend, *c.model, batch);
            });
            if (expected.parameters.empty()) {
              expected = got;
              answers = out;
              made += denormals_in(out) + denormals_in(got.first_moments) + denormals_in(got.second_moments);
            }
            EXPECT_TRUE(got == expected);
            EXPECT_EQ(std::memcmp(out.data(), answers.data(), out.size() * sizeof(float)), 0);
          }
      }
    }
  }
  EXPECT_EQ(made, 0u);
}

TEST(Denormals, SmallWeightsAgreeWithTheReference) {
  for (const float scale : {1e-10f, 1e-19f, 1e-30f, 1e-38f}) {
    const ModelCase c = find_model_case("nrc");
    ModelState state = random_state(*c.model, {}, 2, false);
    for (std::uint64_t i = 0; i < c.model->parameters.network; ++i)
      state.parameters[i] = state.averages[i] *= scale;
    const OwnedBatch batch = make_batch(*c.model, 997, 2, {.border = 0.3f});
    EXPECT_LE(worst_answers(c, {}, state, batch), kTolerance) << scale;
  }
}

}  // namespace
}  // namespace gatelight::neural
