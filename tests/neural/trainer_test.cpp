// A trainer checks its parts and forwards calls to its backend.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/neural/model/cache_files.h"
#include "tests/support/model_batches.h"

namespace gatelight::neural::testing {
namespace {

TEST(Trainer, RefusesMissingPartsAndBadOptions) {
  const ModelCase c = tiny_case();
  const auto held = [&] { return std::make_unique<StoredState>(c.model, TrainingOptions{}, ModelState{}); };
  EXPECT_THROW(Trainer(nullptr, {}, held()), BadConfiguration);
  EXPECT_THROW(Trainer(c.model, {}, nullptr), BadConfiguration);
  TrainingOptions options;
  options.adam.beta1 = 1.0f;
  EXPECT_THROW(Trainer(c.model, options, held()), BadConfiguration);
}

TEST(Trainer, ForwardsCallsToItsBackend) {
  const ModelCase c = tiny_case();
  Trainer trainer = make_trainer(c, {}, 1);
  const std::uint64_t steps = state_of(trainer).steps;
  const OwnedBatch batch = make_batch(*c.model, 5, 1);
  EXPECT_EQ(trainer.train(batch.training()).records, 5u);
  EXPECT_EQ(state_of(trainer).steps, steps + 1);
  std::vector<float> out(5);
  trainer.query(batch.points(), {}, out);
  EXPECT_EQ(out[4], static_cast<float>(steps + 1));
  EXPECT_EQ(&trainer.model(), c.model.get());
}

}  // namespace
}  // namespace gatelight::neural::testing
