#include "neural/vulkan/submission.h"

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

}  // namespace gatelight::neural::vulkan
