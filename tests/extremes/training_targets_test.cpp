// Training: extremes of the targets.

#include "tests/extremes/extreme.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using gatelight::testing::report_extreme;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<ModelCase> usual_cases() {
  return {find_model_case("nrc"), find_model_case("nao"), find_model_case("hash_with_everything")};
}

/// The greatest |answer - target| of the batch after `steps` steps.
double error_after(Backend& backend, const Model& model, const OwnedBatch& batch, int steps) {
  for (int step = 0; step < steps; ++step) backend.train(batch.training());
  const std::vector<float> out = raw_answers(backend, model, batch);
  double worst = 0;
  for (std::size_t i = 0; i < out.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(out[i]) - batch.targets[i]));
  return worst;
}

TEST(ExtremeTargets, BatchesOfOneRecordAgreeWithTheReference) {
  Agreement agreement;
  double worst = 0;
  for (const ModelCase& c : usual_cases()) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const TrainingOptions options = smooth_options();
      const ModelState state = random_state(*c.model, options, seed, true);
      agreement.expect_same("one record", c, options, state, make_smooth_batch(*c.model, state, 1, seed, {}));
    }
    // Training must fit one record.
    const OwnedBatch batch = make_batch(*c.model, 1, 9);
    const auto fast = cpu::make_cpu_backend(c.model, {});
    worst = std::max(worst, error_after(*fast, *c.model, batch, 500));
    expect_sound(*fast, *c.model, batch);
  }
  EXPECT_LE(worst, 1e-3);
  report_extreme("batches of one record", "8 states of 3 models; 500 steps on one record",
                 fmt::format("{}; answer off by {:.1e} (bound 1e-3)", agreement.text(), worst), "");
}

TEST(ExtremeTargets, RecordsOfOneTriangleAgreeWithTheReference) {
  Agreement agreement;
  std::uint64_t most = 0;
  for (const char* name : {"nrc", "nao", "gate_L5_per_triangle_stack_5_a_1", "gate_L2_stack_64"}) {
    const ModelCase c = find_model_case(name);
    for (const FeatureStep step : {FeatureStep::per_node, FeatureStep::per_triangle}) {
      TrainingOptions options = smooth_options();
      options.feature_step = step;
      const ModelState state = random_state(*c.model, options, 3, false);
      const OwnedBatch batch = make_smooth_batch(*c.model, state, 4999, 3, {.crowded = 1.0f});
      agreement.expect_same("one triangle", c, options, state, batch);
      for (const auto& fast : fast_backends(c.model, options)) {
        fast->import_state(state);
        most = std::max(most, fast->train(batch.training()).touched_nodes);
        expect_sound(*fast, *c.model, batch);
      }
    }
  }
  // 65 x 66 / 2 nodes of R = 64.
  EXPECT_LE(most, 2145u);
  report_extreme("all records on one triangle", "4999 records, R = 1 to 64", agreement.text(), "");
}

TEST(ExtremeTargets, TargetsOfZeroAreLearned) {
  Agreement agreement;
  double worst = 0;
  for (const ModelCase& c : usual_cases())
    for (const Loss loss : {Loss::l2, Loss::relative_l2}) {
      TrainingOptions options = smooth_options();
      options.loss = loss;
      const ModelState state = random_state(*c.model, options, 4, true);
      OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 4, {});
      for (float& target : batch.targets)
        if (std::isfinite(target)) target = 0.0f;
      agreement.expect_same("zero", c, options, state, batch);

      OwnedBatch zeros = make_batch(*c.model, 96, 4);
      std::fill(zeros.targets.begin(), zeros.targets.end(), 0.0f);
      TrainingOptions plain;
      plain.loss = loss;
      const auto fast = cpu::make_cpu_backend(c.model, plain);
      worst = std::max(worst, error_after(*fast, *c.model, zeros, 300));
      expect_sound(*fast, *c.model, zeros);
    }
  EXPECT_LE(worst, 0.03);
  report_extreme(
      "all targets 0", "3 models, l2 and relative loss, 300 steps",
      fmt::format("{}; answers off by {:.1e} (bound 0.03, three learning rates)", agreement.text(), worst),
      "");
}

TEST(ExtremeTargets, EqualTargetsAreLearned) {
  Agreement agreement;
  double worst = 0;
  for (const ModelCase& c : usual_cases())
    for (const float value : {1e-6f, 0.7f, 1e6f}) {
      TrainingOptions options = smooth_options();
      options.adam.epsilon = std::max(value, 1.0f);  // of the size of the gradients
      const ModelState state = random_state(*c.model, options, 5, true);
      OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 5, {});
      for (float& target : batch.targets)
        if (std::isfinite(target)) target = value < 10.0f ? 7.0f : value;
      agreement.expect_same("equal", c, options, state, batch);

      OwnedBatch equal = make_batch(*c.model, 96, 5);
      std::fill(equal.targets.begin(), equal.targets.end(), value);
      const auto fast = cpu::make_cpu_backend(c.model, {});
      worst = std::max(worst, error_after(*fast, *c.model, equal, 300) / std::max(1.0f, value));
      expect_sound(*fast, *c.model, equal);
    }
  EXPECT_LE(worst, 0.03);
  report_extreme(
      "all targets equal", "1e-6 to 1e6, 300 steps",
      fmt::format("{}; answers off by {:.1e} of the target, or of 1 (bound 0.03)", agreement.text(), worst),
      "");
}

// Adam remembers the square of a gradient for as long as it is above the usual ones.
TEST(ExtremeTargets, OneTargetOf1e30IsClampedAndForgotten) {
  Agreement agreement;
  double worst = 0;
  for (const ModelCase& c : usual_cases()) {
    TrainingOptions options = smooth_options();
    options.adam.epsilon = options.max_target;
    const ModelState state = random_state(*c.model, options, 6, true);
    OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 6, {});
    const std::size_t outputs = c.model->config.mlp.outputs;
    std::size_t record = 40;
    while (batch.fates[record] != Fate::accepted) ++record;
    batch.targets[record * outputs] = 1e30f;
    agreement.expect_same("1e30", c, options, state, batch);

    // Later on and in the first batch, which sets the output's bias.
    const OwnedBatch usual = make_batch(*c.model, 96, 6);
    OwnedBatch one = usual;
    one.targets[50 * outputs] = 1e30f;
    for (const int before : {0, 50}) {
      const auto fast = cpu::make_cpu_backend(c.model, {});
      for (int step = 0; step < before; ++step) fast->train(usual.training());
      EXPECT_EQ(fast->train(one.training()).clipped, 1u);
      expect_sound(*fast, *c.model, one);
      for (int step = 0; step < 3500; ++step) {
        const double loss = fast->train(usual.training()).loss;
        worst = std::max(worst, step < 3400 ? 0.0 : loss);
      }
      expect_sound(*fast, *c.model, one);
    }
  }
  EXPECT_LE(worst, 0.1);
  report_extreme(
      "one target of 1e30", "in the first batch or after 50 steps, among 96 records of 0.1 to 2",
      fmt::format("clamped to 1e9 and counted; the fit to the others recovers as Adam forgets: relative "
                  "loss {:.1e} 3500 steps later (bound 0.1); {}",
                  worst, agreement.text()),
      "");
}

TEST(ExtremeTargets, OneBrightRecordDoesNotSetTheInitialAnswers) {
  const ModelCase c = find_model_case("nrc");
  OwnedBatch batch = make_batch(*c.model, 4096, 6);
  batch.targets[50] = 1e6f;
  TrainingOptions still;
  still.adam.learning_rate = 0.0f;
  double least = 1e30, greatest = 0;
  for (const auto& fast : fast_backends(c.model, still)) {
    fast->train(batch.training());
    const std::vector<float> start = raw_answers(*fast, *c.model, batch, false);
    const auto [low, high] = std::minmax_element(start.begin(), start.end());
    least = std::min(least, static_cast<double>(*low));
    greatest = std::max(greatest, static_cast<double>(*high));
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LE(greatest, 2.0);
  report_extreme("one target of 1e6 in the first batch", "among 4096 records whose mean is 1.05",
                 fmt::format("answers start at {:.2g} to {:.2g} (bounds 0.5, 2; the mean would be 245)",
                             least, greatest),
                 "");
}

TEST(ExtremeTargets, NanAndInfinityRejectOnlyTheirRecords) {
  Agreement agreement;
  std::uint64_t rejected = 0;
  for (const ModelCase& c : usual_cases())
    for (const float share : {0.01f, 0.5f, 0.99f}) {
      const TrainingOptions options = smooth_options();
      const ModelState state = random_state(*c.model, options, 7, true);
      const OwnedBatch batch = make_smooth_batch(*c.model, state, 1021, 7, {.nonfinite = share});
      rejected += batch.count(Fate::rejected);
      agreement.expect_same("mixed", c, options, state, batch, 3);
    }
  // Every target of a record, with NaN and both infinities.
  const ModelCase c = find_model_case("nrc");
  OwnedBatch batch = make_batch(*c.model, 99, 8);
  for (std::size_t r = 0; r < 99; r += 3)
    batch.targets[3 * r + r % 9 / 3] = r % 2 == 0 ? kNan : r % 4 == 1 ? kInfinity : -kInfinity;
  for (const auto& fast : fast_backends(c.model, {})) {
    const StepStatistics s = fast->train(batch.training());
    EXPECT_EQ(s.rejected, 33u);
    EXPECT_EQ(s.records, 66u);
    EXPECT_TRUE(std::isfinite(s.loss));
    expect_sound(*fast, *c.model, batch);
  }
  report_extreme("NaN and infinity mixed in", "1 to 99 % of 1021 records, in targets and inputs, 3 steps",
                 agreement.text(),
                 fmt::format("{} records left out and counted, none of the others", rejected));
}

}  // namespace
}  // namespace gatelight::neural
