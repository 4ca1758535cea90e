#pragma once
// Records the sort of references by node, and the division into runs and pieces for sums of gradients.

#include "neural/vulkan/commands.h"

namespace gatelight::neural::vulkan {

/// Sorts BatchBlock::keys[0] (nodes, or node_count for no reference) stably and writes the numbers of the
/// references to BatchBlock::values. Returns which of the two pairs of arrays holds the result.
std::uint32_t record_sort(std::uint32_t node_count, std::uint32_t blocks, Commands& commands);

/// Finds runs of equal nodes and their pieces in pair `sorted` of the arrays, and writes their numbers to the
/// statistics.
void record_runs(std::uint32_t sorted, std::uint32_t blocks, Commands& commands);

}  // namespace gatelight::neural::vulkan
