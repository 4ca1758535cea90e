// Every instruction set's kernels agree with the reference in double precision.

#include <gtest/gtest.h>

#include <array>
#include <iterator>

#include "tests/support/parity.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using reference::make_reference_backend;
using simd::Isa;

// Differences are relative to the greatest magnitude in the same tensor (or in a batch's answers). A float
// has a relative error of 2^-24 = 6e-8. Sums of up to 256 terms, sums over records that nearly cancel, and
// positions among 64 nodes or bins have errors of up to 8e-6. Squares (second moments) have twice the error.
constexpr double kTolerance = 3e-5;
// A float position among a level's 256 to 466 cells has that many fewer digits within the cell.
constexpr double kHashGridTolerance = 5e-5;
// The last bit of a float can round a feature to the next fp16 number: one step of fp16, and one more for an
// average. This happens to few features.
constexpr double kHalfTolerance = 0x1p-9;
constexpr double kHalfShare = 0.02;
// Inputs, weights and activations of bf16 queries have eight significant bits, so each product has an error
// of up to 2^-8. Bounds of the worst answer and of the root mean square.
constexpr double kBf16Tolerance = 0.025;
constexpr double kBf16MeanTolerance = 0.006;
// With the default epsilon a step follows the sign of the gradient, which rounding may have changed.
constexpr double kLaterLossTolerance = 1e-4;

// Sizes around the kernels' 16, 8 and 1 lanes, tiles of 48 and chunks of 768, with primes between them.
constexpr std::size_t kAllSizes[] = {0,  1,  2,   3,   5,   7,   8,   9,   11,  13,  15,  16,  17,
                                     19, 23, 29,  31,  37,  41,  43,  47,  48,  49,  61,  89,  95,
                                     96, 97, 127, 191, 193, 251, 384, 509, 767, 768, 769, 1021};
constexpr std::size_t kSmallSizes[] = {1,  2,  15, 16, 17,  31,  47, 48, 49, 61,
                                       95, 96, 97, 97, 127, 149, 7,  11, 23, 33};

std::size_t small_size(std::uint64_t seed) {
  return kSmallSizes[seed % std::size(kSmallSizes)];
}

double tolerance_of(const Model& model) {
  return model.config.encoding == FeatureEncoding::hash_grid ? kHashGridTolerance : kTolerance;
}

TrainingOptions smooth_options() {
  TrainingOptions options;
  make_smooth(options.adam);
  options.start_at_mean = false;  // it would put targets near answers (make_smooth_batch)
  return options;
}

std::vector<float> answers(const Backend& backend, const Model& model, const OwnedBatch& batch, bool averaged,
                           OutputRange range = OutputRange::raw,
                           QueryPrecision precision = QueryPrecision::fp32) {
  std::vector<float> out(batch.size() * model.config.mlp.outputs, -7.0f);
  backend.query(batch.points(), {precision, range, averaged}, out);
  return out;
}

TEST(CpuBackend, StartsWithTheInitialState) {
  for (const char* name :
       {"nrc", "nao", "gate_L5", "gate_L9", "gate_L16", "hash_F2", "plain_direction_identity"}) {
    const ModelCase c = find_model_case(name);
    for (const auto& [word, options] : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + word);
      EXPECT_EQ(cpu::make_cpu_backend(c.model, options)->export_state(), initial_state(*c.model, options));
    }
  }
}

class KernelParity : public ::testing::Test {
 protected:
  static void TearDownTestSuite() { worst_.print(); }

  static void expect_within(double tolerance, double difference, const char* what, const Model& model,
                            Isa isa, const std::string& where) {
    const bool hash = model.config.encoding == FeatureEncoding::hash_grid;
    worst_.meet(isa_name(isa), fmt::format("{}{}", what, hash ? ", hash grid" : ""), difference, where);
    EXPECT_LE(difference, tolerance) << what;
  }

  static void expect_same_answers(const ModelCase& c, const TrainingOptions& options, const OwnedBatch& batch,
                                  const ModelState& state) {
    const auto reference = make_reference_backend(c.model, options);
    reference->import_state(state);
    const std::array expected = {answers(*reference, *c.model, batch, false),
                                 answers(*reference, *c.model, batch, true)};
    const std::string where = fmt::format("{}, {} points", c.name, batch.size());
    for (const Isa isa : simd::available_isas()) {
      SCOPED_TRACE(fmt::format("{}: {}", isa_name(isa), where));
      const auto fast = cpu::make_cpu_backend(c.model, options, isa);
      fast->import_state(state);
      for (const bool averaged : {false, true})
        expect_within(tolerance_of(*c.model),
                      relative_difference(answers(*fast, *c.model, batch, averaged), expected[averaged]),
                      "answers", *c.model, isa, where);
    }
  }

  static void expect_same_step(const std::string& name, const std::shared_ptr<const Model>& model,
                               const TrainingOptions& options, const OwnedBatch& batch,
                               const ModelState& state) {
    const auto reference = make_reference_backend(model, options);
    reference->import_state(state);
    const StepStatistics expected = reference->train(batch.training());
    const ModelState after = reference->export_state();
    const std::array answer = {answers(*reference, *model, batch, false),
                               answers(*reference, *model, batch, true)};
    const std::vector<bool> doubtful = doubtful_nodes(*model, batch);
    const auto doubts = static_cast<double>(std::count(doubtful.begin(), doubtful.end(), true));
    EXPECT_EQ(expected.rejected, batch.count(Fate::rejected));
    EXPECT_EQ(expected.unstored, batch.count(Fate::unstored));
    const std::string where = fmt::format("{}, {} records", name, batch.size());
    for (const Isa isa : simd::available_isas()) {
      SCOPED_TRACE(fmt::format("{}: {}", isa_name(isa), where));
      const auto fast = cpu::make_cpu_backend(model, options, isa);
      fast->import_state(state);
      const StepStatistics statistics = fast->train(batch.training());
      const ModelState got = fast->export_state();
      EXPECT_EQ(statistics.records, expected.records);
      EXPECT_EQ(statistics.rejected, expected.rejected);
      EXPECT_EQ(statistics.unstored, expected.unstored);
      EXPECT_EQ(statistics.clipped, expected.clipped);
      EXPECT_EQ(statistics.skipped_updates, expected.skipped_updates);
      EXPECT_NEAR(static_cast<double>(statistics.touched_nodes), static_cast<double>(expected.touched_nodes),
                  doubts);
      EXPECT_EQ(got.steps, after.steps);
      EXPECT_EQ(got.triangle_steps, after.triangle_steps);
      std::vector<bool> without(model->parameters.node_count, false);
      for (std::size_t n = 0; n < got.node_steps.size(); ++n)
        if (got.node_steps[n] != after.node_steps[n]) {
          EXPECT_TRUE(doubtful[n]) << "node " << n << ": " << got.node_steps[n] << " steps, expected "
                                   << after.node_steps[n];
          without[n] = true;
        }

      const double tolerance = tolerance_of(*model);
      const auto check = [&](const char* what, const std::vector<float>& a, const std::vector<float>& b,
                             double times = 1) {
        expect_within(times * tolerance, tensor_difference(*model, a, b, without), what, *model, isa, where);
      };
      expect_within(tolerance, std::abs(statistics.loss - expected.loss) / std::max(expected.loss, 1e-30),
                    "loss", *model, isa, where);
      check("first moments", got.first_moments, after.first_moments);
      check("second moments", got.second_moments, after.second_moments, 2);
      if (options.precision == FeaturePrecision::fp16) {
        for (const auto& [a, b] :
             {std::pair{&got.parameters, &after.parameters}, {&got.averages, &after.averages}}) {
          EXPECT_LE(tensor_difference(*model, *a, *b, without), kHalfTolerance);
          EXPECT_LE(differing_share(*model, *a, *b, tolerance), kHalfShare);
        }
        continue;
      }
      check("parameters", got.parameters, after.parameters);
      check("averages", got.averages, after.averages);
      if (options.precision != FeaturePrecision::fp32 || std::count(without.begin(), without.end(), true) > 0)
        continue;
      for (const bool averaged : {false, true})
        expect_within(tolerance,
                      relative_difference(answers(*fast, *model, batch, averaged), answer[averaged]),
                      "answers after a step", *model, isa, where);
    }
  }

  static inline Worst worst_;
};

TEST_F(KernelParity, AnswersOfEveryModel) {
  std::uint64_t seed = 1;
  for (const ModelCase& c : all_model_cases()) {
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    const OwnedBatch batch = make_batch(*c.model, small_size(seed), seed,
                                        {.nonfinite = 0.1f, .unstored = 0.1f, .border = 0.3f, .crowded = 0});
    expect_same_answers(c, options, batch, state);
  }
}

TEST_F(KernelParity, AStepOfEveryModel) {
  std::uint64_t seed = 100;
  for (const ModelCase& c : all_model_cases()) {
    TrainingOptions options = smooth_options();
    // Without biases some luminance is near 0, where the relative loss magnifies rounding errors.
    if (++seed % 3 == 0 || !c.model->config.mlp.biases) options.loss = Loss::l2;
    const ModelState state = random_state(*c.model, options, seed, false);
    const OwnedBatch batch =
        make_smooth_batch(*c.model, state, small_size(seed), seed, {.nonfinite = 0.1f, .unstored = 0.1f});
    expect_same_step(c.name, c.model, options, batch, state);
  }
}

TEST_F(KernelParity, AnswersAndStepsOfEveryBatchSize) {
  std::uint64_t seed = 200;
  for (const char* name : {"nrc", "hash_only"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, ++seed, true);
    for (const std::size_t size : kAllSizes) {
      const OwnedBatch batch =
          make_smooth_batch(*c.model, state, size, ++seed, {.nonfinite = 0.05f, .unstored = 0.05f});
      expect_same_answers(c, options, batch, state);
      expect_same_step(c.name, c.model, options, batch, state);
    }
  }
}

TEST_F(KernelParity, AnswersAndStepsOf49152Records) {
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, 7, false);
    const OwnedBatch batch = make_smooth_batch(*c.model, state, 49152, 7,
                                               {.nonfinite = 0.01f, .unstored = 0.01f, .crowded = 0.01f});
    expect_same_step(c.name, c.model, options, batch, state);
  }
}

TEST_F(KernelParity, AStepUnderEveryOption) {
  std::uint64_t seed = 300;
  for (const char* name : {"nrc", "gate_L5_per_triangle_stack_5_a_1", "gate_L2_stack_4_2_1", "hash_F3"}) {
    const ModelCase c = find_model_case(name);
    for (OptionsCase& o : all_training_options(*c.model))
      for (const Loss loss : {Loss::l2, Loss::relative_l2})
        for (const bool trained : {false, true}) {
          // At the first step the mean target becomes the output's bias: let it be far from each target.
          const bool start_at_mean = o.options.start_at_mean && !trained;
          make_smooth(o.options.adam);
          if (o.options.loss == Loss::relative_l2) o.options.loss = loss;
          const ModelState state = random_state(*c.model, o.options, ++seed, trained);
          OwnedBatch batch = make_smooth_batch(*c.model, state, 60 + seed % 41, seed,
                                               {.nonfinite = 0.1f, .unstored = 0.1f, .beyond = 0.05f});
          o.options.max_target = 8.0f;
          for (std::size_t i = 0; start_at_mean && i < batch.targets.size(); i += 2) batch.targets[i] -= 3.0f;
          expect_same_step(fmt::format("{} {}", c.name, o.name), c.model, o.options, batch, state);
        }
  }
}

TEST_F(KernelParity, TargetsBeyondTheGreatestAreClampedAndCounted) {
  const ModelCase c = find_model_case("nrc");
  for (const float greatest : {0.5f, 6.0f, 1e9f}) {
    TrainingOptions options = smooth_options();
    options.max_target = greatest;
    options.adam.epsilon = greatest;  // of the size of the gradients
    const ModelState state = random_state(*c.model, options, 5, false);
    const OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 5, {.beyond = 0.1f});
    expect_same_step(fmt::format("greatest target {}", greatest), c.model, options, batch, state);
    const auto fast = cpu::make_cpu_backend(c.model, options);
    const std::uint64_t clipped = fast->train(batch.training()).clipped;
    EXPECT_EQ(clipped, greatest == 0.5f ? 97 : clipped);
    EXPECT_GE(clipped, batch.count(Fate::clipped));
    EXPECT_GT(batch.count(Fate::clipped), 0u);
  }
}

TEST_F(KernelParity, TheLastTargetIsClampedToo) {
  const ModelCase c = find_model_case("nrc");
  TrainingOptions options;
  options.max_target = 6.0f;
  for (const std::size_t size : {1u, 2u, 5u, 15u, 48u, 49u}) {
    OwnedBatch batch = make_batch(*c.model, size, 5);
    batch.targets.back() = 7.0f;
    for (const Isa isa : simd::available_isas())
      EXPECT_EQ(cpu::make_cpu_backend(c.model, options, isa)->train(batch.training()).clipped, 1u)
          << isa_name(isa) << ", " << size;
  }
}

// One record for each float of each input and for each of NaN, infinity and minus infinity.
TEST_F(KernelParity, ANonFiniteInputRejectsOnlyItsRecord) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const char* name : {"gate_with_everything", "hash_with_everything", "plain_with_everything"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, 9, false);
    OwnedBatch batch = make_smooth_batch(*c.model, state, 101, 9, {});
    std::size_t record = 1;
    const auto spoil = [&](auto place) {
      for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity}) {
        place(record) = bad;
        batch.fates[record] = Fate::rejected;
        record += record % 5 == 0 ? 2 : 1;
      }
    };
    for (std::size_t i = 0; i < 3; ++i) {
      if (i < 2 && !batch.barycentrics.empty())
        spoil([&](std::size_t r) -> float& { return batch.barycentrics[r][i]; });
      for (auto* span : {&batch.positions, &batch.directions, &batch.normals, &batch.albedos})
        spoil([&](std::size_t r) -> float& { return (*span)[r][i]; });
      spoil([&](std::size_t r) -> float& { return batch.targets[3 * r + i]; });
    }
    spoil([&](std::size_t r) -> float& { return batch.roughnesses[r]; });
    ASSERT_LT(record, batch.size());
    expect_same_step(name, c.model, options, batch, state);
    expect_same_answers(c, options, batch, state);
  }
}

TEST_F(KernelParity, InputsThatTheModelDoesNotReadMayBeAnything) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, 9, false);
  OwnedBatch batch = make_smooth_batch(*c.model, state, 50, 9, {});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  batch.positions.assign(50, {nan, nan, nan});
  batch.normals = batch.albedos = batch.positions;
  batch.roughnesses.assign(50, nan);
  expect_same_step("unread inputs", c.model, options, batch, state);
  expect_same_answers(c, options, batch, state);
}

// The points are exact in float and lie on nodes and on the lines between them, so the weights are exact.
TEST_F(KernelParity, NodesWithoutWeightAreNotTouched) {
  for (const char* name : {"gate_L2_stack_4_2_1", "gate_L2_stack_64", "gate_L2_stack_1"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, 3, false);
    const auto reference = make_reference_backend(c.model, options);
    std::vector<std::unique_ptr<Backend>> fast;
    for (const Isa isa : simd::available_isas()) fast.push_back(cpu::make_cpu_backend(c.model, options, isa));
    OwnedBatch batch = make_batch(*c.model, 1, 3);
    for (std::uint32_t i = 0; i <= 8; ++i)
      for (std::uint32_t j = 0; i + j <= 8; ++j) {
        batch.barycentrics = {{static_cast<float>(i) / 8.0f, static_cast<float>(j) / 8.0f}};
        reference->import_state(state);
        const std::uint64_t touched = reference->train(batch.training()).touched_nodes;
        const ModelState expected = reference->export_state();
        for (const auto& backend : fast) {
          backend->import_state(state);
          EXPECT_EQ(backend->train(batch.training()).touched_nodes, touched)
              << name << " " << backend->name() << " at " << i << ", " << j << " of 8";
          EXPECT_EQ(backend->export_state().node_steps, expected.node_steps);
        }
      }
  }
}

TEST_F(KernelParity, LossesOfLaterStepsAgree) {
  for (const char* name : {"nrc", "nao", "hash_F4"})
    for (const Loss loss : {Loss::l2, Loss::relative_l2}) {
      const ModelCase c = find_model_case(name);
      TrainingOptions options;
      options.loss = loss;
      const auto reference = make_reference_backend(c.model, options);
      std::vector<std::unique_ptr<Backend>> fast;
      for (const Isa isa : simd::available_isas())
        fast.push_back(cpu::make_cpu_backend(c.model, options, isa));
      for (std::uint64_t step = 0; step < 20; ++step) {
        const OwnedBatch batch =
            make_batch(*c.model, 401, 500 + step, {.nonfinite = 0.02f, .unstored = 0.02f});
        const double expected = reference->train(batch.training()).loss;
        for (std::size_t i = 0; i < fast.size(); ++i) {
          const double difference = std::abs(fast[i]->train(batch.training()).loss - expected) / expected;
          expect_within(kLaterLossTolerance, difference, "loss of 20 steps", *c.model,
                        simd::available_isas()[i], fmt::format("{} step {}", name, step));
        }
      }
    }
}

TEST_F(KernelParity, AnswersInBf16) {
  std::uint64_t seed = 600;
  for (const char* name : {"nrc", "nao", "hash_F4", "gate_with_everything", "hash_with_everything",
                           "mlp_1x16", "mlp_3x16_no_biases", "mlp_5x128", "mlp_4x64_no_biases", "outputs_16",
                           "gate_L7", "leaky_slope_0_percent", "plain_256_inputs"}) {
    const ModelCase c = find_model_case(name);
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    const OwnedBatch batch = make_batch(*c.model, 197, seed, {.nonfinite = 0.1f, .unstored = 0.1f});
    const auto reference = make_reference_backend(c.model, options);
    reference->import_state(state);
    for (const bool averaged : {false, true}) {
      const std::vector<float> expected = answers(*reference, *c.model, batch, averaged);
      for (const Isa isa : simd::available_isas()) {
        SCOPED_TRACE(fmt::format("{}: {}", isa_name(isa), name));
        const auto fast = cpu::make_cpu_backend(c.model, options, isa);
        fast->import_state(state);
        const std::vector<float> got =
            answers(*fast, *c.model, batch, averaged, OutputRange::raw, QueryPrecision::bf16);
        expect_within(kBf16Tolerance, relative_difference(got, expected), "bf16 answers", *c.model, isa,
                      name);
        double squares = 0, scale = 0;
        for (std::size_t i = 0; i < got.size(); ++i)
          if (std::isfinite(expected[i])) {
            squares += std::pow(static_cast<double>(got[i]) - expected[i], 2);
            scale = std::max(scale, std::abs(static_cast<double>(expected[i])));
          }
        expect_within(kBf16MeanTolerance, std::sqrt(squares / static_cast<double>(got.size())) / scale,
                      "bf16 answers, root mean square", *c.model, isa, name);
        EXPECT_NE(got, answers(*fast, *c.model, batch, averaged)) << "bf16 is to round";
      }
    }
  }
}

TEST_F(KernelParity, RangesClampTheRawAnswers) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options;
  ModelState state = random_state(*c.model, options, 4, true);
  for (std::uint32_t o = 0; o < 3; ++o) state.averages[c.model->parameters.layers.back().biases + o] = 0.4f;
  const OwnedBatch batch = make_batch(*c.model, 211, 4, {.nonfinite = 0.1f, .unstored = 0.1f});
  for (const Isa isa : simd::available_isas())
    for (const QueryPrecision precision : {QueryPrecision::fp32, QueryPrecision::bf16}) {
      const auto fast = cpu::make_cpu_backend(c.model, options, isa);
      fast->import_state(state);
      const std::vector<float> raw = answers(*fast, *c.model, batch, true, OutputRange::raw, precision);
      const std::vector<float> positive =
          answers(*fast, *c.model, batch, true, OutputRange::non_negative, precision);
      const std::vector<float> unit = answers(*fast, *c.model, batch, true, OutputRange::unit, precision);
      expect_ranges(*c.model, batch, raw, positive, unit);
    }
}

}  // namespace
}  // namespace gatelight::neural
