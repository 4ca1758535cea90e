#include "apps/reports/device_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/terminal/text.h"
#include "neural/base/errors.h"

namespace gatelight::apps {

DeviceReport find_devices() {
  try {
    DeviceReport report{neural::vulkan::list_devices(), ""};
    if (report.devices.empty()) report.reason = "no device";
    return report;
  } catch (const neural::Unavailable& error) {
    return {{}, error.what()};
  }
}

std::string devices_text(const DeviceReport& report) {
  if (report.devices.empty()) return fmt::format("{:<14} {}\n", "vulkan", report.reason);
  std::string text;
  for (std::size_t i = 0; i < report.devices.size(); ++i) {
    const neural::vulkan::DeviceListing& device = report.devices[i];
    text += fmt::format("{:<14} {}: {} ({}, Vulkan {}, {}){}{}\n", i == 0 ? "vulkan" : "", i, device.name,
                        device.kind, device.version, format_bytes(device.memory_bytes),
                        device.refusal.empty() ? "" : ", cannot be used: ", device.refusal);
  }
  return text;
}

nlohmann::ordered_json devices_json(const DeviceReport& report) {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const neural::vulkan::DeviceListing& device : report.devices)
    devices.push_back({{"name", device.name},
                       {"kind", device.kind},
                       {"version", device.version},
                       {"memory_bytes", device.memory_bytes},
                       {"usable", device.refusal.empty()},
                       {"refusal", device.refusal}});
  return {{"built_in", neural::vulkan::is_built_in()}, {"reason", report.reason}, {"devices", devices}};
}

}  // namespace gatelight::apps
