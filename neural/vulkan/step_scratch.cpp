#include "neural/vulkan/step_scratch.h"

#include <algorithm>
#include <bit>

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint64_t kMaxTile = 64;
constexpr std::uint64_t kOutputRows = 16;
constexpr std::uint64_t kDigits = 16;
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
  cut.blocks = static_cast<std::uint32_t>((references + kSortBlock - 1) / kSortBlock);
  return cut;
}

std::uint64_t most_records(const Model& model, std::uint64_t longest_buffer) {
  const ParameterLayout& layout = model.parameters;
  const std::uint64_t floats =
      std::max<std::uint64_t>({layout.inputs, model.config.mlp.outputs, 3u,
                               std::uint64_t{model.nodes_per_point()} * std::max(layout.features, 1u)});
  return longest_buffer / (4 * floats) - 1;
}

void StepScratch::reserve(const Device& device, const Model& model, std::uint64_t records,
                          std::uint32_t tile) {
  if (records <= capacity()) return;
  const ParameterLayout& layout = model.parameters;
  const StepCut cut = cut_step(model, records, tile);
  const std::uint64_t references = cut.references;
  const std::uint64_t nodes = std::min<std::uint64_t>(references, layout.node_count);
  auto buffer = buffers_.begin();
  const auto words = [&](Address& address, std::uint64_t count) {
    vulkan::reserve(device, *buffer, 4 * count, BufferUse::device);
    address = (buffer++)->address();
  };
  block_.capacity = 0;  // in case an allocation below throws
  words(block_.inputs, records * layout.inputs);
  words(block_.status, records);
  words(block_.record_triangles, records);
  for (Address& keys : block_.keys) words(keys, references);
  for (Address& values : block_.values) words(values, references);
  words(block_.weights, references);
  words(block_.feature_gradients, records * layout.feature_inputs);
  words(block_.losses, cut.tiles);
  words(block_.partials, std::uint64_t{cut.groups} * layout.network_count());
  words(block_.counts, kDigits * cut.blocks);
  words(block_.piece_starts, references + 1);
  words(block_.piece_sums, references * layout.features);
  words(block_.piece_steps, references);
  words(block_.nodes, nodes);
  words(block_.node_pieces, nodes + 1);
  block_.capacity = cut.size;
}

}  // namespace gatelight::neural::vulkan
