#pragma once
// The Vulkan backend: compute shaders for any device with Vulkan 1.2.

#include <memory>

#include "neural/model/backend.h"
#include "neural/vulkan/devices.h"

namespace gatelight::neural::vulkan {

/// Throws BadConfiguration, OutOfDeviceMemory or DeviceLost.
std::unique_ptr<Backend> make_vulkan_backend(std::shared_ptr<Machine> machine,
                                             std::shared_ptr<const Model> model,
                                             const TrainingOptions& options);

}  // namespace gatelight::neural::vulkan
