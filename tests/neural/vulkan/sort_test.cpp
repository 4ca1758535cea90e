// The sort of references by node against the standard library, and the sums over its runs.

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "neural/vulkan/machine.h"
#include "neural/vulkan/sort_commands.h"
#include "neural/vulkan/submission.h"
#include "neural/vulkan/transfer.h"
#include "tests/neural/vulkan/device.h"
#include "tests/support/counter_random.h"

namespace gatelight::neural::vulkan {
namespace {

using neural::testing::OnVulkan;
using neural::testing::test_machine;

using Words = std::vector<std::uint32_t>;

class VulkanSort : public OnVulkan {};

constexpr std::uint32_t kPiece = 64;

struct Reference {
  std::uint32_t node = 0, number = 0;
  friend bool operator==(const Reference&, const Reference&) = default;
};

struct Sorted {
  std::vector<Reference> references;
  std::vector<float> sums;  ///< of the weights of each piece, at its first reference
  std::uint32_t runs = 0;
};

/// Weights are small whole numbers, so that their sums are exact.
float weight_of(std::uint32_t number) {
  return static_cast<float>(number % 1000 + 1);
}

Sorted expected_of(const Words& keys, std::uint32_t nodes) {
  Sorted s;
  for (std::uint32_t i = 0; i < keys.size(); ++i) s.references.push_back({keys[i], i});
  std::ranges::stable_sort(s.references, {}, &Reference::node);
  s.sums.resize(keys.size());
  std::size_t piece = 0;
  for (std::size_t i = 0; i < keys.size() && s.references[i].node < nodes; ++i) {
    const bool run = i == 0 || s.references[i].node != s.references[i - 1].node;
    if (run) ++s.runs;
    if (run || i % kPiece == 0) piece = i;
    s.sums[piece] += weight_of(s.references[i].number);
  }
  return s;
}

/// Sorts and sums on the device. A record has one reference with one feature, and gradient 1.
Sorted sort_on_device(const Words& keys, std::uint32_t nodes) {
  Machine& machine = *test_machine();
  const Device& device = machine.device();
  Transfer transfer(device);
  const auto count = static_cast<std::uint32_t>(keys.size());
  const auto make = [&](std::size_t words) { return Buffer(device, 4 * words, BufferUse::device); };
  const Buffer key_array = make(count), sorted[2] = {make(2 * count), make(2 * count)}, weights = make(count),
               gradients = make(count), counts = make(kSortCountWords), sums = make(count),
               statistics = make(glsl::kStatisticsWords);
  ModelBlock model;
  model.node_count = nodes;
  model.level_count = model.nodes_per_level = model.feature_inputs = 1;
  BatchBlock batch;
  batch.keys = key_array.address();
  for (std::size_t i = 0; i < 2; ++i) batch.sorted[i] = sorted[i].address();
  batch.weights = weights.address();
  batch.feature_gradients = gradients.address();
  batch.counts = counts.address();
  batch.piece_sums = sums.address();
  batch.statistics = statistics.address();
  batch.references = count;
  const Buffer model_block = make(sizeof(model) / 4), batch_block = make(sizeof(batch) / 4);
  const auto put = [&](const Buffer& to, const auto& values) {
    transfer.write(to, std::as_bytes(std::span(values)));
  };
  put(model_block, std::span(&model, 1));
  put(batch_block, std::span(&batch, 1));
  put(key_array, keys);
  std::vector<float> floats(count, 1.0f);
  put(gradients, floats);
  for (std::uint32_t i = 0; i < count; ++i) floats[i] = weight_of(i);
  put(weights, floats);
  transfer.fill(counts, ~0u);
  transfer.fill(sums, 0);
  transfer.fill(statistics, 0);

  const Submission submission(device);
  Commands commands(submission.commands.front(), machine, model_block.address(), batch_block.address());
  const SortPlan plan = plan_sort(nodes, count);
  record_sort_clear(plan, commands);
  commands.barrier();
  record_sort_start(plan, commands);
  commands.barrier();
  record_sort_rest(plan, commands);
  commands.dispatch(Shader::sum_pieces, Words{1, 0}, std::min<std::uint64_t>(groups_for(count), 100),
                    plan.result());
  commands.submit(submission.fence);
  wait_for(device, submission.fence);

  Sorted result{std::vector<Reference>(count), std::vector<float>(count)};
  transfer.read(sorted[plan.result()], std::as_writable_bytes(std::span(result.references)));
  transfer.read(sums, std::as_writable_bytes(std::span(result.sums)));
  Words counters(glsl::kStatisticsWords);
  transfer.read(statistics, std::as_writable_bytes(std::span(counters)));
  result.runs = counters[glsl::kTouched];
  return result;
}

void expect_sorted(const Words& keys, std::uint32_t nodes) {
  SCOPED_TRACE(fmt::format("{} references to {} nodes", keys.size(), nodes));
  const Sorted expected = expected_of(keys, nodes), got = sort_on_device(keys, nodes);
  EXPECT_TRUE(got.references == expected.references);
  EXPECT_EQ(got.sums, expected.sums);
  EXPECT_EQ(got.runs, expected.runs);
}

/// Keys up to `nodes`, which is no node.
Words random_keys(std::size_t references, std::uint32_t nodes) {
  neural::testing::Random random{references + nodes};
  Words keys(references);
  for (std::uint32_t& key : keys) key = random.below(nodes + 1);
  return keys;
}

TEST_F(VulkanSort, IsStableForManySizesAndNodes) {
  for (const std::uint32_t nodes : {1u, 2u, 255u, 256u, 257u, 65535u, 65536u, (1u << 20) + 3, 0xfffffffeu})
    for (const std::size_t references : {1u, 2u, 127u, 129u, 511u, 513u, 10000u, 16384u, 16385u, 40001u})
      expect_sorted(random_keys(references, nodes), nodes);
}

TEST_F(VulkanSort, KeepsTheOrderOfEqualAndOfOrderedReferences) {
  for (const std::size_t references : {5000u, 70000u}) {
    expect_sorted(Words(references, 3), 10);
    expect_sorted(Words(references, 10), 10);
    Words keys = random_keys(references, 3000);
    std::ranges::sort(keys);
    expect_sorted(keys, 3000);
    std::ranges::reverse(keys);
    expect_sorted(keys, 3000);
  }
}

TEST_F(VulkanSort, GivesAWorkgroupSeveralChunks) {
  expect_sorted(random_keys(1000003, 5000), 5000);
}

}  // namespace
}  // namespace gatelight::neural::vulkan
