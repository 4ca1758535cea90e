#pragma once
// Which device is used, and why another is not. Knows no Vulkan call, so that it can be tested without a
// device.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace gatelight::neural::vulkan {

/// In the order of preference.
enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, software, other };
std::string_view kind_name(DeviceKind kind);

struct DeviceFacts {
  std::string name;
  DeviceKind kind = DeviceKind::other;
  std::uint32_t major = 0, minor = 0;  ///< of its Vulkan
  bool compute_queue = false;
  bool buffer_addresses = false;  ///< the feature bufferDeviceAddress
  std::uint32_t workgroup_threads = 0;
  std::uint32_t shared_bytes = 0;
};

inline constexpr std::uint32_t kWorkgroupThreads = 128;
inline constexpr std::uint32_t kLeastSharedBytes = 16384;

/// Empty where the device can be used.
std::string refusal(const DeviceFacts& device);

/// The index of the device that `wanted` names (an index, part of a name in any case, or nothing: the best
/// kind that can be used). Throws Unavailable, listing what there is.
std::size_t choose_device(std::span<const DeviceFacts> devices, std::string_view wanted);

}  // namespace gatelight::neural::vulkan
