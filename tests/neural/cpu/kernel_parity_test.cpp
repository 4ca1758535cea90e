// Every instruction set's kernels agree with the reference in double precision: for every model, batch size
// and option.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/neural/agreement_loops.h"
#include "tests/neural/cpu/kernel_agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using reference::make_reference_backend;
using simd::Isa;

// With the default epsilon a step follows the sign of the gradient, which rounding may have changed.
constexpr double kLaterLossTolerance = 1e-4;
// The bound of the root mean square of bf16 queries; kBf16Tolerance is that of the worst answer.
constexpr double kBf16MeanTolerance = 0.006;

// Sizes around the kernels' 16, 8 and 1 lanes, tiles of 48 and chunks of 768, with primes between them.
constexpr std::size_t kAllSizes[] = {0,  1,  2,   3,   5,   7,   8,   9,   11,  13,  15,  16,  17,
                                     19, 23, 29,  31,  37,  41,  43,  47,  48,  49,  61,  89,  95,
                                     96, 97, 127, 191, 193, 251, 384, 509, 767, 768, 769, 1021};

class KernelParity : public AgreesOnKernels {};

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

TEST_F(KernelParity, AnswersOfEveryModel) {
  std::uint64_t seed = 1;
  for (const ModelCase& c : all_model_cases()) {
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    const OwnedBatch batch = make_batch(*c.model, small_size(seed), seed,
                                        {.nonfinite = 0.1f, .unstored = 0.1f, .border = 0.3f, .crowded = 0});
    agreement().expect_same_answers(c, options, batch, state);
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
    agreement().expect_same_step(c.name, c.model, options, batch, state);
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
      agreement().expect_same_answers(c, options, batch, state);
      agreement().expect_same_step(c.name, c.model, options, batch, state);
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
    agreement().expect_same_step(c.name, c.model, options, batch, state);
  }
}

TEST_F(KernelParity, AStepUnderEveryOption) {
  expect_same_step_under_options(
      agreement(), {"nrc", "gate_L5_per_triangle_stack_5_a_1", "gate_L2_stack_4_2_1", "hash_F3"},
      {Loss::l2, Loss::relative_l2});
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
      const TrainingOptions options{.loss = loss};
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
          agreement().expect_within(kLaterLossTolerance, difference, "loss of 20 steps", *c.model,
                                    std::string(isa_name(simd::available_isas()[i])),
                                    fmt::format("{} step {}", name, step));
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
      const std::vector<float> expected = raw_answers(*reference, *c.model, batch, averaged);
      for (const Isa isa : simd::available_isas()) {
        SCOPED_TRACE(fmt::format("{}: {}", isa_name(isa), name));
        const auto fast = cpu::make_cpu_backend(c.model, options, isa);
        fast->import_state(state);
        const std::vector<float> got = raw_answers(*fast, *c.model, batch, averaged, QueryPrecision::bf16);
        agreement().expect_within(kBf16Tolerance, relative_difference(got, expected), "bf16 answers",
                                  *c.model, std::string(isa_name(isa)), name);
        double squares = 0, scale = 0;
        for (std::size_t i = 0; i < got.size(); ++i)
          if (std::isfinite(expected[i])) {
            squares += std::pow(static_cast<double>(got[i]) - expected[i], 2);
            scale = std::max(scale, std::abs(static_cast<double>(expected[i])));
          }
        agreement().expect_within(
            kBf16MeanTolerance, std::sqrt(squares / static_cast<double>(got.size())) / scale,
            "bf16 answers, root mean square", *c.model, std::string(isa_name(isa)), name);
        EXPECT_NE(got, raw_answers(*fast, *c.model, batch, averaged)) << "bf16 is to round";
      }
    }
  }
}

TEST_F(KernelParity, RangesClampTheRawAnswers) {
  for (const Isa isa : simd::available_isas())
    for (const QueryPrecision precision : {QueryPrecision::fp32, QueryPrecision::bf16})
      expect_clamped_answers(*cpu::make_cpu_backend(find_model_case("nrc").model, {}, isa), precision);
}

}  // namespace
}  // namespace gatelight::neural
