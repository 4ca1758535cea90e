#pragma once
// The choice of a device. It makes no Vulkan call, so that it can be tested without a device.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace gatelight::neural::vulkan {

/// Kinds in the order of preference.
enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, software, other };
std::string_view kind_name(DeviceKind kind);

struct DeviceFacts {
  std::string name;
  DeviceKind kind = DeviceKind::other;
  std::uint32_t major = 0, minor = 0;  ///< Vulkan version
  bool compute_queue = false;
  bool buffer_addresses = false;  ///< the feature bufferDeviceAddress
  std::uint32_t workgroup_threads = 0;
  std::uint32_t shared_bytes = 0;
};

inline constexpr std::uint32_t kWorkgroupThreads = 128;
inline constexpr std::uint32_t kMinSharedBytes = 16384;

/// The reason why a device cannot be used; empty if it can.
std::string refusal(const DeviceFacts& device);

/// The index of the device that `wanted` names: an index, or part of a name, ignoring case. If it is empty,
/// the first usable device of the best kind. Throws Unavailable, which lists the devices.
std::size_t choose_device(std::span<const DeviceFacts> devices, std::string_view wanted);

/// The index of the first usable device of the best kind that is hardware; empty if there is none.
std::optional<std::size_t> choose_hardware(std::span<const DeviceFacts> devices);

}  // namespace gatelight::neural::vulkan
