#include "neural/vulkan/submission.h"

#include <limits>

namespace gatelight::neural::vulkan {

Submission::Submission(const Device& device)
    : pool(device.handle(), vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient |
                                                          vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                      device.queue_family())),
      commands(device.handle(), vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1)),
      fence(device.handle(), vk::FenceCreateInfo()) {
  if (device.limits().nanoseconds_per_tick > 0.0)
    stamps =
        vk::raii::QueryPool(device.handle(), vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, kStamps));
}

double seconds_between(const Device& device, const Submission& submission, std::uint32_t from,
                       std::uint32_t to) {
  if (!*submission.stamps) return 0.0;
  const auto ticks = [&](std::uint32_t stamp) {
    return submission.stamps
        .getResult<std::uint64_t>(stamp, 1, sizeof(std::uint64_t),
                                  vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait)
        .second;
  };
  // Counters with fewer bits wrap.
  const std::uint64_t passed = (ticks(to) - ticks(from)) & device.limits().tick_mask;
  return static_cast<double>(passed) * device.limits().nanoseconds_per_tick * 1e-9;
}

void full_barrier(const vk::raii::CommandBuffer& commands) {
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  const vk::MemoryBarrier barrier(Access::eShaderWrite | Access::eTransferWrite,
                                  Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead |
                                      Access::eTransferWrite | Access::eHostRead);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer,
                           Stage::eComputeShader | Stage::eTransfer | Stage::eHost, {}, barrier, {}, {});
}

void begin_commands(const vk::raii::CommandBuffer& commands) {
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  full_barrier(commands);
}

void submit_commands(const Device& device, const vk::raii::CommandBuffer& commands,
                     const vk::raii::Fence& fence) {
  full_barrier(commands);
  commands.end();
  const vk::CommandBuffer handle = *commands;
  device.queue().submit(vk::SubmitInfo({}, {}, handle), *fence);
}

void wait_for(const Device& device, const vk::raii::Fence& fence) {
  constexpr std::uint64_t kForever = std::numeric_limits<std::uint64_t>::max();
  while (device.handle().waitForFences(*fence, VK_TRUE, kForever) == vk::Result::eTimeout) {
  }
  device.handle().resetFences(*fence);
}

}  // namespace gatelight::neural::vulkan
