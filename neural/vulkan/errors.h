#pragma once
// Converts Vulkan's errors to those of the library.

#include <string>
#include <utility>

#include <vulkan/vulkan_raii.hpp>

namespace gatelight::neural::vulkan {

/// Throws DeviceLost, OutOfDeviceMemory or Unavailable; the message names the device and the action.
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
