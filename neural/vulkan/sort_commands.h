#pragma once
// Records the sort of references by node (shaders/sort.glsl).

#include "neural/vulkan/commands.h"

namespace gatelight::neural::vulkan {

/// Words of BatchBlock::counts.
inline constexpr std::uint32_t kSortCountWords =
    glsl::kDigits * (glsl::kMostBlocks + glsl::kMostPasses * glsl::kSumsAPass);

/// The division of a sort of BatchBlock::keys: nodes, or node_count for no reference.
struct SortPlan {
  std::uint32_t passes = 0, digit_bits = 0, blocks = 0;
  bool counted = false;  ///< by a dispatch before each pass; in a small sort each workgroup counts everything
  /// The array of BatchBlock::sorted with the result.
  std::uint32_t result() const { return (passes + 1) % 2; }
};
SortPlan plan_sort(std::uint32_t node_count, std::uint32_t references);

// The three parts of a sort, with a barrier between them.

/// Can run before the keys are there.
void record_sort_clear(const SortPlan& plan, Commands& commands);
/// Records the first dispatch that reads the keys.
void record_sort_start(const SortPlan& plan, Commands& commands);
/// Records the other dispatches, each with a barrier behind it.
void record_sort_rest(const SortPlan& plan, Commands& commands);

}  // namespace gatelight::neural::vulkan
