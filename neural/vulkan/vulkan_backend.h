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

/// The device's time for the last query of a Vulkan backend; zeros without timestamps.
struct QuerySeconds {
  double encode = 0.0, network = 0.0, copies = 0.0;
};
QuerySeconds last_query_seconds(const Backend& backend);

}  // namespace gatelight::neural::vulkan
