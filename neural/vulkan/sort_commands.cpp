#include "neural/vulkan/sort_commands.h"

#include <algorithm>
#include <array>
#include <bit>

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint32_t kMostDigitBits = std::bit_width(glsl::kDigits - 1);
// References of a block, while there are few blocks.
constexpr std::uint32_t kCountedBlock = 1024, kUncountedBlock = 512;
// Up to this many references, counting all of them in each workgroup takes less time than a dispatch.
constexpr std::uint32_t kMostUncounted = 16384;

std::uint32_t dispatches_of(const SortPlan& plan) {
  return plan.counted ? 2 * plan.passes : plan.passes;
}

void record_dispatch(const SortPlan& plan, std::uint32_t number, Commands& commands) {
  if (plan.counted && number % 2 == 0)
    commands.dispatch(Shader::sort_count, {}, plan.blocks, number / 2, plan.digit_bits);
  else
    commands.dispatch(Shader::sort_scatter, std::array{std::uint32_t{plan.counted}}, plan.blocks,
                      plan.counted ? number / 2 : number, plan.digit_bits);
}

}  // namespace

SortPlan plan_sort(std::uint32_t node_count, std::uint32_t references) {
  const auto bits = static_cast<std::uint32_t>(std::bit_width(node_count));
  SortPlan plan;
  plan.passes = (bits + kMostDigitBits - 1) / kMostDigitBits;
  plan.digit_bits = (bits + plan.passes - 1) / plan.passes;
  plan.counted = references > kMostUncounted;
  const std::uint32_t block = plan.counted ? kCountedBlock : kUncountedBlock;
  plan.blocks = std::min((references + block - 1) / block, glsl::kMostBlocks);
  return plan;
}

void record_sort_clear(const SortPlan& plan, Commands& commands) {
  if (plan.counted)
    commands.dispatch(Shader::sort_clear, {}, groups_for(glsl::kDigits * glsl::kSumsAPass * plan.passes));
}

void record_sort_start(const SortPlan& plan, Commands& commands) {
  record_dispatch(plan, 0, commands);
}

void record_sort_rest(const SortPlan& plan, Commands& commands) {
  for (std::uint32_t number = 1; number < dispatches_of(plan); ++number) {
    record_dispatch(plan, number, commands);
    commands.barrier();
  }
}

}  // namespace gatelight::neural::vulkan
