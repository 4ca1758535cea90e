#include "neural/vulkan/barrier.h"

#include <limits>

namespace gatelight::neural::vulkan {

void full_barrier(const vk::raii::CommandBuffer& commands) {
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  const vk::MemoryBarrier barrier(Access::eShaderWrite | Access::eTransferWrite,
                                  Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                      Access::eTransferWrite | Access::eHostRead);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer,
                           Stage::eComputeShader | Stage::eTransfer | Stage::eHost, {}, barrier, {}, {});
}

void wait_for(const Device& device, const vk::raii::Fence& fence) {
  constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();
  while (device.handle().waitForFences(*fence, VK_TRUE, kForever) == vk::Result::eTimeout) {
  }
  device.handle().resetFences(*fence);
}

}  // namespace gatelight::neural::vulkan
