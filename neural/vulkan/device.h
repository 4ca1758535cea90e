#pragma once
// A logical device with one compute queue, and its limits.

#include <cstdint>
#include <string>

#include <vulkan/vulkan_raii.hpp>

namespace gatelight::neural::vulkan {

struct DeviceLimits {
  std::uint32_t shared_bytes = 0;
  std::uint64_t longest_buffer = 0;   ///< bytes
  std::uint32_t groups = 0;           ///< maximum workgroups in a dispatch's first dimension
  std::uint64_t device_bytes = 0;     ///< size of the largest device-local heap
  double nanoseconds_per_tick = 0.0;  ///< of timestamps; 0 means no timestamps
  std::uint64_t tick_mask = 0;        ///< valid bits of timestamps
  vk::PhysicalDeviceMemoryProperties memory;
};

std::uint64_t greatest_device_heap(const vk::PhysicalDeviceMemoryProperties& memory);

class Device {
 public:
  explicit Device(vk::raii::PhysicalDevice physical);

  const vk::raii::Device& handle() const { return device_; }
  const vk::raii::Queue& queue() const { return queue_; }
  std::uint32_t queue_family() const { return family_; }
  const DeviceLimits& limits() const { return limits_; }
  const std::string& name() const { return name_; }

  /// The first memory type of the mask `allowed` with all `needed` properties; one that also has the `wanted`
  /// properties is preferred. Throws Unavailable if there is none.
  std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags needed,
                            vk::MemoryPropertyFlags wanted) const;

 private:
  vk::raii::PhysicalDevice physical_;
  std::uint32_t family_;
  std::string name_;
  DeviceLimits limits_;
  vk::raii::Device device_;
  vk::raii::Queue queue_;
};

}  // namespace gatelight::neural::vulkan
