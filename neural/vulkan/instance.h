#pragma once
// The loader, an instance, and the messages of the validation layer.

#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "neural/vulkan/device_choice.h"
#include "neural/vulkan/devices.h"

namespace gatelight::neural::vulkan {

class Instance {
 public:
  /// Throws Unavailable if there is no loader, or if `validate` is set and the layer is missing. `messages`
  /// may be null.
  Instance(bool validate, std::shared_ptr<ValidationMessages> messages);

  std::vector<vk::raii::PhysicalDevice> devices() const;
  /// Throws ValidationFailed with the first message since the last check, if any.
  void check_messages();

 private:
  std::shared_ptr<ValidationMessages> messages_;
  vk::raii::Context context_;
  vk::raii::Instance instance_;
  vk::raii::DebugUtilsMessengerEXT messenger_;
};

DeviceFacts facts_of(const vk::raii::PhysicalDevice& device);

/// The first queue family with compute, preferably without graphics, so that work does not wait for the
/// desktop.
std::uint32_t compute_family(const vk::raii::PhysicalDevice& device);

}  // namespace gatelight::neural::vulkan
