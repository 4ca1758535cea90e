#include "neural/vulkan/submission.h"

#include <limits>

namespace gatelight::neural::vulkan {

namespace {

using Access = vk::AccessFlagBits;
constexpr vk::AccessFlags kWritten = Access::eShaderWrite | Access::eTransferWrite;
constexpr vk::PipelineStageFlags kWork =
    vk::PipelineStageFlagBits::eComputeShader | vk::PipelineStageFlagBits::eTransfer;

}  // namespace

Submission::Submission(const Device& device, std::uint32_t stamp_count)
    : pool(device.handle(), vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eTransient |
                                                          vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                      device.queue_family())),
      commands(device.handle(), vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1)),
      fence(device.handle(), vk::FenceCreateInfo()) {
  if (stamp_count > 0 && device.limits().nanoseconds_per_tick > 0.0)
    stamps = vk::raii::QueryPool(device.handle(),
                                 vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, stamp_count));
}

std::vector<double> stamped_seconds(const Device& device, const Submission& submission, std::size_t count) {
  std::vector<double> seconds(count, 0.0);
  if (!*submission.stamps) return seconds;
  const std::vector<std::uint64_t> ticks =
      submission.stamps
          .getResults<std::uint64_t>(0, static_cast<std::uint32_t>(count), count * sizeof(std::uint64_t),
                                     sizeof(std::uint64_t),
                                     vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait)
          .second;
  // Counters with fewer bits wrap.
  for (std::size_t i = 0; i < count; ++i)
    seconds[i] = static_cast<double>((ticks[i] - ticks[0]) & device.limits().tick_mask) *
                 device.limits().nanoseconds_per_tick * 1e-9;
  return seconds;
}

void full_barrier(const vk::raii::CommandBuffer& commands) {
  const vk::MemoryBarrier barrier(
      kWritten, Access::eShaderRead | Access::eShaderWrite | Access::eTransferRead | Access::eTransferWrite);
  commands.pipelineBarrier(kWork, kWork, {}, barrier, {}, {});
}

void begin_commands(const vk::raii::CommandBuffer& commands) {
  commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
  full_barrier(commands);
}

void submit_commands(const Device& device, const vk::raii::CommandBuffer& commands,
                     const vk::raii::Fence& fence) {
  const vk::MemoryBarrier for_host(kWritten, Access::eHostRead);
  commands.pipelineBarrier(kWork, vk::PipelineStageFlagBits::eHost, {}, for_host, {}, {});
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
