// Records that the kernels clamp or reject, as the reference does.

#include <gtest/gtest.h>

#include <limits>

#include "tests/neural/cpu/kernel_agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using simd::Isa;

class KernelRecords : public AgreesOnKernels {};

TEST_F(KernelRecords, TargetsBeyondTheGreatestAreClampedAndCounted) {
  const ModelCase c = find_model_case("nrc");
  for (const float greatest : {0.5f, 6.0f, 1e9f}) {
    TrainingOptions options = smooth_options();
    options.max_target = greatest;
    options.adam.epsilon = greatest;  // of the size of the gradients
    const ModelState state = random_state(*c.model, options, 5, false);
    const OwnedBatch batch = make_smooth_batch(*c.model, state, 97, 5, {.beyond = 0.1f});
    agreement().expect_same_step(fmt::format("greatest target {}", greatest), c.model, options, batch, state);
    const auto fast = cpu::make_cpu_backend(c.model, options);
    const std::uint64_t clipped = fast->train(batch.training()).clipped;
    EXPECT_EQ(clipped, greatest == 0.5f ? 97 : clipped);
    EXPECT_GE(clipped, batch.count(Fate::clipped));
    EXPECT_GT(batch.count(Fate::clipped), 0u);
  }
}

TEST_F(KernelRecords, TheLastTargetIsClampedToo) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options{.max_target = 6.0f};
  for (const std::size_t size : {1u, 2u, 5u, 15u, 48u, 49u}) {
    OwnedBatch batch = make_batch(*c.model, size, 5);
    batch.targets.back() = 7.0f;
    for (const Isa isa : simd::available_isas())
      EXPECT_EQ(cpu::make_cpu_backend(c.model, options, isa)->train(batch.training()).clipped, 1u)
          << isa_name(isa) << ", " << size;
  }
}

// One record for each float of each input and for each of NaN, infinity and minus infinity.
TEST_F(KernelRecords, ANonFiniteInputRejectsOnlyItsRecord) {
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
    agreement().expect_same_step(name, c.model, options, batch, state);
    agreement().expect_same_answers(c, options, batch, state);
  }
}

TEST_F(KernelRecords, InputsThatTheModelDoesNotReadMayBeAnything) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options = smooth_options();
  const ModelState state = random_state(*c.model, options, 9, false);
  OwnedBatch batch = make_smooth_batch(*c.model, state, 50, 9, {});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  batch.positions.assign(50, {nan, nan, nan});
  batch.normals = batch.albedos = batch.positions;
  batch.roughnesses.assign(50, nan);
  agreement().expect_same_step("unread inputs", c.model, options, batch, state);
  agreement().expect_same_answers(c, options, batch, state);
}

}  // namespace
}  // namespace gatelight::neural
