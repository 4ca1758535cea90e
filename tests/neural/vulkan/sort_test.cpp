// The sort of references by node and its split into runs and pieces, against the standard library.

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "neural/vulkan/machine.h"
#include "neural/vulkan/sort_commands.h"
#include "neural/vulkan/step_scratch.h"
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

struct Sorted {
  Words keys, values, piece_starts, nodes, node_pieces;
};

constexpr std::uint32_t kPiece = 64;

Sorted expected_of(const Words& keys, std::uint32_t nodes) {
  Sorted s;
  s.values.resize(keys.size());
  std::iota(s.values.begin(), s.values.end(), 0u);
  std::ranges::stable_sort(s.values, {}, [&](std::uint32_t i) { return keys[i]; });
  for (const std::uint32_t i : s.values) s.keys.push_back(keys[i]);
  std::uint32_t end = 0;
  for (std::uint32_t i = 0; i < s.keys.size() && s.keys[i] < nodes; end = ++i) {
    const bool run = i == 0 || s.keys[i] != s.keys[i - 1];
    if (run) {
      s.nodes.push_back(s.keys[i]);
      s.node_pieces.push_back(static_cast<std::uint32_t>(s.piece_starts.size()));
    }
    if (run || i % kPiece == 0) s.piece_starts.push_back(i);
  }
  s.node_pieces.push_back(static_cast<std::uint32_t>(s.piece_starts.size()));
  s.piece_starts.push_back(end);
  return s;
}

Sorted sort_on_device(const Words& keys, std::uint32_t nodes) {
  Machine& machine = *test_machine();
  const Device& device = machine.device();
  Transfer transfer(device);
  const auto make = [&](std::size_t words) { return Buffer(device, 4 * words, BufferUse::device); };
  const auto references = static_cast<std::uint32_t>(keys.size());
  const std::uint32_t blocks = (references + kSortBlock - 1) / kSortBlock;
  const Buffer key_arrays[2] = {make(references), make(references)};
  const Buffer value_arrays[2] = {make(references), make(references)};
  const Buffer counts = make(16 * blocks), piece_starts = make(references + 1), node_list = make(references),
               node_pieces = make(references + 1), statistics = make(glsl::kStatisticsWords);
  ModelBlock model;
  model.node_count = nodes;
  BatchBlock batch;
  for (std::size_t i = 0; i < 2; ++i) {
    batch.keys[i] = key_arrays[i].address();
    batch.values[i] = value_arrays[i].address();
  }
  batch.counts = counts.address();
  batch.piece_starts = piece_starts.address();
  batch.nodes = node_list.address();
  batch.node_pieces = node_pieces.address();
  batch.statistics = statistics.address();
  batch.references = references;
  batch.blocks = blocks;
  const Buffer model_block(device, sizeof(model), BufferUse::device),
      batch_block(device, sizeof(batch), BufferUse::device);
  transfer.write(model_block, std::as_bytes(std::span(&model, 1)));
  transfer.write(batch_block, std::as_bytes(std::span(&batch, 1)));
  transfer.write(key_arrays[0], std::as_bytes(std::span(keys)));

  const Submission submission(device);
  Commands commands(submission.commands.front(), machine, model_block.address(), batch_block.address());
  const std::uint32_t sorted = record_sort(nodes, blocks, commands);
  record_runs(sorted, blocks, commands);
  commands.submit(submission.fence);
  wait_for(device, submission.fence);

  const auto get = [&](const Buffer& from, std::size_t words) {
    Words result(words);
    transfer.read(from, std::as_writable_bytes(std::span(result)));
    return result;
  };
  const Words counters = get(statistics, glsl::kStatisticsWords);
  return {get(key_arrays[sorted], references), get(value_arrays[sorted], references),
          get(piece_starts, counters[glsl::kPieces] + 1), get(node_list, counters[glsl::kTouched]),
          get(node_pieces, counters[glsl::kTouched] + 1)};
}

void expect_sorted(const Words& keys, std::uint32_t nodes) {
  SCOPED_TRACE(fmt::format("{} references to {} nodes", keys.size(), nodes));
  const Sorted expected = expected_of(keys, nodes), got = sort_on_device(keys, nodes);
  EXPECT_EQ(got.keys, expected.keys);
  EXPECT_EQ(got.values, expected.values);
  EXPECT_EQ(got.nodes, expected.nodes);
  if (expected.nodes.empty()) return;  // an empty list has no end
  EXPECT_EQ(got.node_pieces, expected.node_pieces);
  EXPECT_EQ(got.piece_starts, expected.piece_starts);
}

TEST_F(VulkanSort, IsStableForManySizesAndNodes) {
  neural::testing::Random random{1};
  for (const std::uint32_t nodes : {1u, 15u, 16u, 300u, 70000u, 20000000u})
    for (const std::size_t references : {1u, 2u, 64u, 127u, 2047u, 2048u, 2049u, 10000u}) {
      Words keys(references);
      for (std::uint32_t& key : keys) key = random.below(nodes + 1);  // the key `nodes` is no node
      expect_sorted(keys, nodes);
    }
}

TEST_F(VulkanSort, KeepsTheOrderWhereAllReferencesShareANode) {
  expect_sorted(Words(5000, 3), 10);
  expect_sorted(Words(5000, 10), 10);
}

TEST_F(VulkanSort, SortsManyBlocks) {
  neural::testing::Random random{2};
  Words keys(300000);
  for (std::uint32_t& key : keys) key = random.below(5000);
  expect_sorted(keys, 4000 + 1000);
}

}  // namespace
}  // namespace gatelight::neural::vulkan
