#include "neural/vulkan/device.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"
#include "neural/vulkan/instance.h"

namespace gatelight::neural::vulkan {

namespace {

// Shaders index words with signed 32-bit numbers.
constexpr std::uint64_t kLongestBuffer = std::uint64_t{1} << 31;

vk::raii::Device make_device(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  vk::PhysicalDeviceVulkan12Features features;
  features.bufferDeviceAddress = VK_TRUE;
  const vk::DeviceCreateInfo info({}, queue, {}, {}, nullptr, &features);
  return {physical, info};
}

DeviceLimits limits_of(const vk::raii::PhysicalDevice& physical, std::uint32_t family) {
  const auto chain =
      physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance3Properties>();
  const vk::PhysicalDeviceLimits& limits = chain.get<vk::PhysicalDeviceProperties2>().properties.limits;
  DeviceLimits result;
  result.shared_bytes = limits.maxComputeSharedMemorySize;
  result.longest_buffer = std::min<std::uint64_t>(
      kLongestBuffer, chain.get<vk::PhysicalDeviceMaintenance3Properties>().maxMemoryAllocationSize);
  result.groups = std::min(limits.maxComputeWorkGroupCount[0], 65535u);
  const std::uint32_t bits = physical.getQueueFamilyProperties()[family].timestampValidBits;
  if (bits > 0) result.nanoseconds_per_tick = static_cast<double>(limits.timestampPeriod);
  result.tick_mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  result.memory = physical.getMemoryProperties();
  result.device_bytes = greatest_device_heap(result.memory);
  return result;
}

}  // namespace

std::uint64_t greatest_device_heap(const vk::PhysicalDeviceMemoryProperties& memory) {
  std::uint64_t greatest = 0;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & vk::MemoryHeapFlagBits::eDeviceLocal)
      greatest = std::max<std::uint64_t>(greatest, memory.memoryHeaps[i].size);
  return greatest;
}

Device::Device(vk::raii::PhysicalDevice physical)
    : physical_(std::move(physical)),
      family_(compute_family(physical_)),
      name_(physical_.getProperties().deviceName.data()),
      limits_(limits_of(physical_, family_)),
      device_(make_device(physical_, family_)),
      queue_(device_, family_, 0) {}

std::uint32_t Device::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags needed,
                                  vk::MemoryPropertyFlags wanted) const {
  const auto find = [&](vk::MemoryPropertyFlags flags) {
    for (std::uint32_t i = 0; i < limits_.memory.memoryTypeCount; ++i)
      if ((allowed >> i & 1u) != 0 && (limits_.memory.memoryTypes[i].propertyFlags & flags) == flags)
        return i;
    return ~0u;
  };
  std::uint32_t type = find(needed | wanted);
  if (type == ~0u) type = find(needed);
  if (type == ~0u) throw Unavailable(fmt::format("{}: no memory that is {}", name_, vk::to_string(needed)));
  return type;
}

}  // namespace gatelight::neural::vulkan
