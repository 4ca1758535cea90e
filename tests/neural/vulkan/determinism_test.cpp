// Results have the same bits each time, however arrays are split and steps overlap. States can move between
// devices.

#include "neural/trainer.h"
#include "tests/neural/vulkan/agreement.h"
#include "tests/support/stored_state.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using vulkan::make_vulkan_backend;

class VulkanDeterminism : public OnVulkan {};

std::vector<OwnedBatch> some_batches(const Model& model) {
  std::vector<OwnedBatch> batches;
  for (const std::size_t size : {700u, 64u, 0u, 1u, 333u})
    batches.push_back(make_batch(model, size, 40 + size,
                                 {.nonfinite = 0.02f, .unstored = 0.02f, .border = 0.1f, .crowded = 0.5f}));
  return batches;
}

/// Returns every option for one model, the defaults for the others.
std::vector<OptionsCase> options_for(const std::string& name, const Model& model) {
  return name == "nrc" ? all_training_options(model) : std::vector<OptionsCase>{{"defaults", {}}};
}

struct Outcome {
  ModelState state;
  std::vector<double> losses;
  std::vector<float> answers;
};

Outcome learn(Backend& backend, const Model& model, const std::vector<OwnedBatch>& batches) {
  Outcome outcome;
  for (const OwnedBatch& batch : batches) outcome.losses.push_back(backend.train(batch.training()).loss);
  outcome.state = backend.export_state();
  outcome.answers = answers(backend, model, batches[0], {});
  return outcome;
}

void expect_same(const Outcome& a, const Outcome& b) {
  EXPECT_TRUE(same_bits(a.state, b.state));
  EXPECT_EQ(a.losses, b.losses);
  EXPECT_EQ(std::memcmp(a.answers.data(), b.answers.data(), 4 * a.answers.size()), 0);
}

TEST_F(VulkanDeterminism, RepeatedStepsWithArraysInManyPartsHaveTheSameBits) {
  const std::shared_ptr<vulkan::Machine> tiny = open_test_machine(256);
  for (const char* name : {"nrc", "gate_L5_per_triangle_stack_5_a_1", "hash_F3"}) {
    const ModelCase c = find_model_case(name);
    const auto batches = some_batches(*c.model);
    for (const OptionsCase& o : options_for(name, *c.model)) {
      SCOPED_TRACE(std::string(name) + " " + o.name);
      const auto whole = make_vulkan_backend(test_machine(), c.model, o.options);
      const auto parts = make_vulkan_backend(tiny, c.model, o.options);
      expect_same(learn(*whole, *c.model, batches), learn(*parts, *c.model, batches));
    }
  }
}

void expect_same_in_groups(const ModelCase& c, const std::vector<OwnedBatch>& batches,
                           std::initializer_list<std::size_t> group_sizes) {
  const Outcome expected = learn(*make_vulkan_backend(test_machine(), c.model, {}), *c.model, batches);
  std::vector<TrainingBatch> all;
  for (const OwnedBatch& batch : batches) all.push_back(batch.training());
  for (const std::size_t size : group_sizes) {
    SCOPED_TRACE(fmt::format("{} in groups of {}", c.name, size));
    const auto backend = make_vulkan_backend(test_machine(), c.model, {});
    for (std::size_t i = 0; i < all.size(); i += size)
      backend->start(std::span(all).subspan(i, std::min(size, all.size() - i)));
    Outcome outcome;
    outcome.answers = answers(*backend, *c.model, batches[0], {});
    outcome.state = backend->export_state();
    for (std::size_t i = 0; i < all.size(); ++i) outcome.losses.push_back(backend->finish().loss);
    EXPECT_THROW(backend->finish(), BadConfiguration);
    expect_same(expected, outcome);
  }
}

// The first step that accepts a record starts at the mean; a submission has at most 64 steps.
TEST_F(VulkanDeterminism, GroupsOfStepsHaveTheBitsOfSequentialSteps) {
  for (const char* name : {"nrc", "plain_direction_identity"}) {
    const ModelCase c = find_model_case(name);
    std::vector<OwnedBatch> batches = {make_batch(*c.model, 40, 1, {.nonfinite = 1.0f})};
    while (batches.size() < 70)
      for (OwnedBatch& batch : some_batches(*c.model)) batches.push_back(std::move(batch));
    expect_same_in_groups(c, batches, {1, 3, batches.size()});
  }
}

// Their batches take more bytes than a submission has, and arrays grow between them.
TEST_F(VulkanDeterminism, AGroupOfLargeStepsHasTheBitsOfSequentialSteps) {
  const ModelCase c = find_model_case("nrc");
  std::vector<OwnedBatch> batches;
  for (const std::size_t size : {20000u, 60000u, 70000u}) batches.push_back(make_batch(*c.model, size, size));
  expect_same_in_groups(c, batches, {3});
}

TEST_F(VulkanDeterminism, AGroupWithAnInvalidBatchChangesNothing) {
  const ModelCase c = find_model_case("nrc");
  const auto backend = make_vulkan_backend(test_machine(), c.model, {});
  const ModelState before = backend->export_state();
  std::vector<OwnedBatch> batches = some_batches(*c.model);
  batches.back().targets.pop_back();
  std::vector<TrainingBatch> all;
  for (const OwnedBatch& batch : batches) all.push_back(batch.training());
  EXPECT_THROW(backend->start(all), BadConfiguration);
  EXPECT_THROW(backend->finish(), BadConfiguration);
  EXPECT_EQ(backend->export_state(), before);
}

TEST_F(VulkanDeterminism, ImportedStatesAreExportedAndTrainedWithTheSameBits) {
  for (const char* name : {"nrc", "gate_L5", "hash_F2", "plain_direction_identity"}) {
    const ModelCase c = find_model_case(name);
    for (const OptionsCase& o : all_training_options(*c.model)) {
      SCOPED_TRACE(std::string(name) + " " + o.name);
      const auto backend = make_vulkan_backend(test_machine(), c.model, o.options);
      EXPECT_EQ(backend->export_state(), initial_state(*c.model, o.options));
      const ModelState state = random_state(*c.model, o.options, 3, true);
      backend->import_state(state);
      const ModelState held = backend->export_state();
      if (o.options.precision != FeaturePrecision::fp16 && o.options.average.network) {
        EXPECT_TRUE(same_bits(held, state));
      }
      const OwnedBatch batch = make_batch(*c.model, 100, 4);
      backend->train(batch.training());
      const ModelState gone_on = backend->export_state();
      const auto other = make_vulkan_backend(test_machine(), c.model, o.options);
      other->import_state(held);
      other->train(batch.training());
      EXPECT_TRUE(same_bits(other->export_state(), gone_on));
    }
  }
}

TEST_F(VulkanDeterminism, AnImportedInitialStateStartsAtTheMeanAgain) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options;
  const OwnedBatch batch = make_batch(*c.model, 100, 4);
  const auto backend = make_vulkan_backend(test_machine(), c.model, options);
  backend->train(batch.training());
  const ModelState once = backend->export_state();
  backend->import_state(initial_state(*c.model, options));
  backend->train(batch.training());
  EXPECT_TRUE(same_bits(backend->export_state(), once));
}

TEST_F(VulkanDeterminism, ACacheMovesBetweenDevices) {
  const ModelCase c = find_model_case("nrc");
  const TrainingOptions options;
  Trainer device(c.model, options, make_vulkan_backend(test_machine(), c.model, options));
  for (const OwnedBatch& batch : some_batches(*c.model)) device.train(batch.training());
  const tests::TemporaryFolder folder;
  const std::filesystem::path path = folder / "cache";
  device.save(path, "moves");
  Trainer host(c.model, options, cpu::make_cpu_backend(c.model, options));
  host.load(path, "moves");
  EXPECT_TRUE(same_bits(host.backend().export_state(), device.backend().export_state()));
  const OwnedBatch points = make_batch(*c.model, 500, 8);
  EXPECT_LT(relative_difference(answers(host.backend(), *c.model, points, {}),
                                answers(device.backend(), *c.model, points, {})),
            1e-5);
  host.train(points.training());
  host.save(path, "moves");
  device.load(path, "moves");
  EXPECT_TRUE(same_bits(host.backend().export_state(), device.backend().export_state()));
}

}  // namespace
}  // namespace gatelight::neural
