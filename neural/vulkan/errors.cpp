#include "neural/vulkan/errors.h"

#include <fmt/format.h>

#include "base/errors.h"

namespace gatelight::neural::vulkan {

void rethrow(const vk::SystemError& error, const std::string& device, const char* deed) {
  const auto result = static_cast<vk::Result>(error.code().value());
  const std::string where = fmt::format("{}, {}", device, deed);
  if (result == vk::Result::eErrorDeviceLost) throw DeviceLost(where + ": the Vulkan device was lost");
  if (result == vk::Result::eErrorOutOfDeviceMemory || result == vk::Result::eErrorOutOfHostMemory)
    throw OutOfDeviceMemory(where + ": out of memory");
  throw Unavailable(fmt::format("{}: {}", where, vk::to_string(result)));
}

}  // namespace gatelight::neural::vulkan
