#pragma once
// References to nodes, sorted and cut into the runs and pieces that gradients are summed by.

#include "neural/vulkan/commands.h"

namespace gatelight::neural::vulkan {

/// Sorts Batch::keys[0] (nodes, or node_count for none) and numbers the references in Batch::values, stably.
/// Returns which of the two pairs of arrays holds the result.
std::uint32_t record_sort(std::uint32_t node_count, std::uint32_t blocks, Commands& commands);

/// Runs of equal nodes and their pieces, of the arrays that record_sort named; how many there are goes to the
/// statistics.
void record_runs(std::uint32_t sorted, std::uint32_t blocks, Commands& commands);

}  // namespace gatelight::neural::vulkan
