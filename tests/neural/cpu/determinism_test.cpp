// Training and answers are the same, bit for bit, for any number of threads.

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>
#include <string>
#include <vector>

#include "neural/cpu/cpu_backend.h"
#include "neural/trainer.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using simd::Isa;

constexpr int kThreads[] = {1, 2, 7};
#if defined(__SANITIZE_THREAD__)
constexpr int kManySteps = 10;  // slow, and a race shows in a few
#else
constexpr int kManySteps = 100;
#endif

template <class F>
auto on_threads(int threads, F&& body) {
  // The control lets the arena have more threads than the machine has cores.
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 8);
  tbb::task_arena arena(threads);
  return arena.execute(body);
}

struct Outcome {
  ModelState state;
  std::vector<double> losses;
  std::vector<float> answers;  // fp32, then bf16
  std::string file;
};

Outcome train(const std::shared_ptr<const Model>& model, const TrainingOptions& options, Isa isa,
              std::span<const OwnedBatch> batches, int steps) {
  Trainer trainer(model, options, cpu::make_cpu_backend(model, options, isa));
  Outcome outcome;
  for (int step = 0; step < steps; ++step)
    outcome.losses.push_back(
        trainer.train(batches[static_cast<std::size_t>(step) % batches.size()].training()).loss);
  outcome.state = trainer.backend().export_state();
  const OwnedBatch& points = batches[0];
  const std::size_t count = points.size() * model->config.mlp.outputs;
  outcome.answers.resize(2 * count);
  const std::span<float> out = outcome.answers;
  trainer.query(points.points(), {}, out.first(count));
  trainer.query(points.points(), {QueryPrecision::bf16}, out.last(count));
  const tests::TemporaryFolder folder;
  trainer.save(folder / "cache", "determinism");
  outcome.file = tests::read_file(folder / "cache");
  return outcome;
}

void expect_same_for_any_threads(const std::string& name, const std::shared_ptr<const Model>& model,
                                 const TrainingOptions& options, std::span<const OwnedBatch> batches,
                                 int steps) {
  for (const Isa isa : simd::available_isas()) {
    Outcome first;
    for (const int threads : kThreads) {
      SCOPED_TRACE(fmt::format("{} {} {} threads", name, isa_name(isa), threads));
      Outcome outcome = on_threads(threads, [&] { return train(model, options, isa, batches, steps); });
      if (threads == kThreads[0]) {
        first = std::move(outcome);
        EXPECT_GT(first.file.size(), 1000u);
        continue;
      }
      EXPECT_TRUE(outcome.state == first.state);
      EXPECT_EQ(outcome.losses, first.losses);
      EXPECT_EQ(std::memcmp(outcome.answers.data(), first.answers.data(), first.answers.size() * 4), 0);
      EXPECT_TRUE(outcome.file == first.file) << "cache files differ";
    }
  }
}

std::vector<OwnedBatch> batches_of(const Model& model, std::span<const std::size_t> sizes, float crowded) {
  std::vector<OwnedBatch> batches;
  for (const std::size_t size : sizes)
    batches.push_back(make_batch(
        model, size, 40 + size, {.nonfinite = 0.02f, .unstored = 0.02f, .border = 0.1f, .crowded = crowded}));
  return batches;
}

// From many chunks of records down to less than a tile, and none.
constexpr std::size_t kSizes[] = {1600, 768, 1, 769, 0, 100};

TEST(Determinism, ManyStepsAreTheSameForAnyNumberOfThreads) {
  for (const char* name : {"nrc", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (const FeatureUpdate update : {FeatureUpdate::sparse, FeatureUpdate::dense}) {
      const TrainingOptions options{.update = update};
      const auto batches = batches_of(*c.model, kSizes, 0.2f);
      expect_same_for_any_threads(fmt::format("{}{}", name, update == FeatureUpdate::dense ? " dense" : ""),
                                  c.model, options, batches, kManySteps);
    }
  }
}

TEST(Determinism, EveryOptionIsTheSameForAnyNumberOfThreads) {
  constexpr std::size_t kFew[] = {1600, 100};
  for (const char* name : {"gate_L5_per_triangle", "hash_F3"}) {
    const ModelCase c = find_model_case(name);
    const auto batches = batches_of(*c.model, kFew, 0.5f);
    for (const OptionsCase& o : all_training_options(*c.model))
      expect_same_for_any_threads(fmt::format("{} {}", name, o.name), c.model, o.options, batches, 6);
  }
}

// More than 65536 nodes: a thousand buckets of many nodes each, and one bucket that all records share.
TEST(Determinism, ManyNodesAreTheSameForAnyNumberOfThreads) {
  ModelConfig config = default_gate_config();
  config.gate.stack = {kMaxResolution, 1};
  const ModelCase c = make_case("finest", config);
  ASSERT_GT(c.model->parameters.node_count, 65536u);
  constexpr std::size_t kLarge[] = {8000};
  expect_same_for_any_threads("finest", c.model, {}, batches_of(*c.model, kLarge, 0.3f), 3);
}

}  // namespace
}  // namespace gatelight::neural
