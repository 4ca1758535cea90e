#pragma once
// What `gatelight info` tells of --device vulkan.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "neural/vulkan/devices.h"

namespace gatelight::apps {

struct DeviceReport {
  std::vector<neural::vulkan::DeviceListing> devices;
  std::string reason;  ///< why there are none
};
DeviceReport find_devices();

/// A line for each device.
std::string devices_text(const DeviceReport& report);
nlohmann::ordered_json devices_json(const DeviceReport& report);

}  // namespace gatelight::apps
