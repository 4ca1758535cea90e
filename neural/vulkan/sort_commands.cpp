#include "neural/vulkan/sort_commands.h"

#include <bit>

namespace gatelight::neural::vulkan {

namespace {

constexpr std::uint32_t kDigitBits = 4;
constexpr std::uint32_t kNowhere = ~0u;  // makes scan discard the totals

}  // namespace

std::uint32_t record_sort(std::uint32_t node_count, std::uint32_t blocks, Commands& commands) {
  const auto bits = static_cast<std::uint32_t>(std::bit_width(node_count));
  std::uint32_t shift = 0;
  for (; shift < bits; shift += kDigitBits) {
    commands.dispatch(Shader::sort_count, {}, blocks, shift);
    commands.barrier();
    commands.dispatch(Shader::scan, {}, 1, (1u << kDigitBits) * blocks, kNowhere);
    commands.barrier();
    commands.dispatch(Shader::sort_scatter, {}, blocks, shift);
    commands.barrier();
  }
  return shift / kDigitBits % 2;
}

void record_runs(std::uint32_t sorted, std::uint32_t blocks, Commands& commands) {
  commands.dispatch(Shader::mark_count, {}, blocks, sorted);
  commands.barrier();
  commands.dispatch(Shader::scan, {}, 2, blocks, glsl::kPieces);
  commands.barrier();
  commands.dispatch(Shader::mark_write, {}, blocks, sorted);
  commands.barrier();
}

}  // namespace gatelight::neural::vulkan
