#pragma once
// Vulkan's failures as the library's.

#include <string>
#include <utility>

#include <vulkan/vulkan_raii.hpp>

namespace gatelight::neural::vulkan {

/// Throws what the error means: DeviceLost, OutOfDeviceMemory or Unavailable, naming device and deed.
[[noreturn]] void rethrow(const vk::SystemError& error, const std::string& device, const char* deed);

template <class F>
auto translated(const std::string& device, const char* deed, F&& body) {
  try {
    return std::forward<F>(body)();
  } catch (const vk::SystemError& error) {
    rethrow(error, device, deed);
  }
}

}  // namespace gatelight::neural::vulkan
