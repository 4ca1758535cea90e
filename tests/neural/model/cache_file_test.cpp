// A cache file restores each state to the bit; a trainer checks its parts.

#include <gtest/gtest.h>

#include <string>

#include "neural/cpu/cpu_backend.h"
#include "tests/neural/model/cache_files.h"
#include "tests/support/model_batches.h"

namespace gatelight::neural::testing {
namespace {

TEST(CacheFile, EveryConfigurationIsRestoredBitForBit) {
  const TemporaryFolder folder;
  for (const char* name :
       {"nrc", "nao", "gate_L2_per_triangle", "gate_only", "mlp_5x16_no_biases", "outputs_16", "hash_F4",
        "hash_memory_target", "plain_256_inputs", "gate_with_position"}) {
    const ModelCase c = find_model_case(name);
    for (const auto& [options_name, options] : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + options_name);
      const Trainer saved = make_trainer(c, options, 1);
      saved.save(folder / "a", kFingerprint);
      Trainer loaded = make_trainer(c, options, 2);
      ASSERT_FALSE(same_bits(state_of(loaded), state_of(saved)));
      loaded.load(folder / "a", kFingerprint);
      EXPECT_TRUE(same_bits(state_of(loaded), state_of(saved)));
    }
  }
}

// The file holds all state that training changes: a loaded cache trains on like one that was never saved.
TEST(CacheFile, TrainingContinuesBitForBit) {
  const TemporaryFolder folder;
  for (const char* name : {"nrc", "nao", "hash_F4", "plain_256_inputs"}) {
    const ModelCase c = find_model_case(name);
    const OwnedBatch batches[] = {make_batch(*c.model, 300, 1), make_batch(*c.model, 300, 2)};
    for (const auto& [options_name, options] : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + options_name);
      const auto learner = [&c, &chosen = options] {
        return Trainer(c.model, chosen, cpu::make_cpu_backend(c.model, chosen));
      };
      Trainer straight = learner();
      for (int step = 0; step < 6; ++step) {
        if (step == 3) straight.save(folder / "a", kFingerprint);
        straight.train(batches[step % 2].training());
      }
      Trainer loaded = learner();
      loaded.train(batches[1].training());
      loaded.load(folder / "a", kFingerprint);
      for (int step = 3; step < 6; ++step) loaded.train(batches[step % 2].training());
      EXPECT_TRUE(same_bits(state_of(loaded), state_of(straight)));
    }
  }
}

TEST(Trainer, RefusesMissingPartsAndBadOptions) {
  const ModelCase c = tiny_case();
  const auto held = [&] { return std::make_unique<StoredState>(c.model, TrainingOptions{}, ModelState{}); };
  EXPECT_THROW(Trainer(nullptr, {}, held()), BadConfiguration);
  EXPECT_THROW(Trainer(c.model, {}, nullptr), BadConfiguration);
  TrainingOptions options;
  options.adam.beta1 = 1.0f;
  EXPECT_THROW(Trainer(c.model, options, held()), BadConfiguration);
}

}  // namespace
}  // namespace gatelight::neural::testing
