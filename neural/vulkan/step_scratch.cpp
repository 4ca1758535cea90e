#include "neural/vulkan/step_scratch.h"

#include <algorithm>
#include <bit>

#include "neural/vulkan/sort_commands.h"

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint64_t kMaxTile = 64;
constexpr std::uint64_t kOutputRows = 16;
// The sums of weight gradients of all workgroups take about kPartialBytes, with kFewestGroups to kMaxGroups
// workgroups.
constexpr std::uint64_t kPartialBytes = std::uint64_t{64} << 20;
constexpr std::uint64_t kFewestGroups = 16;
constexpr std::uint64_t kMaxGroups = 1024;

}  // namespace

// A row has one float more than the tile has records, and one float per record lies behind the rows.
std::uint32_t training_tile(const Model& model, std::uint32_t shared_bytes) {
  const MlpOptions& mlp = model.config.mlp;
  const std::uint64_t rows = model.parameters.inputs + mlp.hidden_layers * mlp.width + kOutputRows;
  const std::uint64_t most = (shared_bytes / 4 - rows) / (rows + 1);
  return static_cast<std::uint32_t>(std::bit_floor(std::clamp<std::uint64_t>(most, 1, kMaxTile)));
}

StepCut cut_step(const Model& model, std::uint64_t records, std::uint32_t tile) {
  const std::uint64_t references = records * model.nodes_per_point();
  const std::uint64_t tiles = (records + tile - 1) / tile;
  const std::uint64_t groups =
      std::clamp(kPartialBytes / (4 * model.parameters.network_count()), kFewestGroups, kMaxGroups);
  StepCut cut;
  cut.size = static_cast<std::uint32_t>(records);
  cut.references = static_cast<std::uint32_t>(references);
  cut.tiles = static_cast<std::uint32_t>(tiles);
  cut.groups = static_cast<std::uint32_t>(std::min(tiles, groups));
  return cut;
}

std::uint64_t most_records(const Model& model, std::uint64_t longest_buffer) {
  const ParameterLayout& layout = model.parameters;
  const std::uint64_t floats =
      std::max<std::uint64_t>({layout.inputs, model.config.mlp.outputs, 3u,
                               std::uint64_t{model.nodes_per_point()} * std::max(layout.features, 2u)});
  return longest_buffer / (4 * floats) - 1;
}

void StepScratch::reserve(const Device& device, const Model& model, std::uint64_t records,
                          std::uint32_t tile) {
  if (records <= capacity()) return;
  const ParameterLayout& layout = model.parameters;
  const StepCut cut = cut_step(model, records, tile);
  const std::uint64_t references = cut.references;
  auto buffer = buffers_.begin();
  const auto words = [&](Address& address, std::uint64_t count) {
    vulkan::reserve(device, *buffer, 4 * count, BufferUse::device);
    address = (buffer++)->address();
  };
  block_.capacity = 0;  // in case an allocation below throws
  words(block_.inputs, records * layout.inputs);
  words(block_.status, records);
  words(block_.record_triangles, records);
  words(block_.keys, references);
  for (Address& pairs : block_.sorted) words(pairs, 2 * references);
  words(block_.weights, references);
  words(block_.feature_gradients, records * layout.feature_inputs);
  words(block_.losses, cut.tiles);
  words(block_.partials, std::uint64_t{cut.groups} * layout.network_count());
  words(block_.counts, kSortCountWords);
  words(block_.piece_sums, references * layout.features);
  words(block_.piece_steps, references);
  block_.capacity = cut.size;
}

}  // namespace gatelight::neural::vulkan
