#include "neural/vulkan/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "neural/vulkan/errors.h"

namespace gatelight::neural::vulkan {

namespace {

bool validation_wanted(const MachineOptions& options) {
  const char* const variable = std::getenv("GATELIGHT_VULKAN_VALIDATION");
  return options.validate || (variable != nullptr && *variable != '\0' && std::string_view(variable) != "0");
}

/// For tests.
std::uint64_t submissions_before_loss() {
  const char* const variable = std::getenv("GATELIGHT_VULKAN_LOSE_AFTER");
  const std::uint64_t count = variable != nullptr ? std::strtoull(variable, nullptr, 10) : 0;
  return count != 0 ? count : std::numeric_limits<std::uint64_t>::max();
}

std::vector<DeviceFacts> facts_of_all(std::span<const vk::raii::PhysicalDevice> devices) {
  std::vector<DeviceFacts> facts;
  facts.reserve(devices.size());
  for (const vk::raii::PhysicalDevice& device : devices) facts.push_back(facts_of(device));
  return facts;
}

vk::raii::PhysicalDevice choose(const Instance& instance, const std::string& wanted) {
  std::vector<vk::raii::PhysicalDevice> devices = instance.devices();
  return std::move(devices[choose_device(facts_of_all(devices), wanted)]);
}

/// Whether Linux has a file through which a driver would reach a device: of Mesa, NVIDIA, or Windows' host.
bool has_device_file() {
  const char* const files[] = {"/dev/dri", "/dev/nvidiactl", "/dev/dxg"};
  std::error_code unreadable;
  return std::ranges::any_of(files,
                             [&](const char* file) { return std::filesystem::exists(file, unreadable); });
}

}  // namespace

Machine::Machine(const MachineOptions& options)
    : instance_(validation_wanted(options), options.messages),
      device_(choose(instance_, options.device)),
      pipelines_(device_),
      longest_part_(options.longest_part != 0
                        ? std::min(options.longest_part, device_.limits().longest_buffer)
                        : device_.limits().longest_buffer),
      lose_after_(submissions_before_loss()) {}

void Machine::count_submission() {
  if (++work_.submissions > lose_after_) throw vk::DeviceLostError("lost for a test");
}

bool is_built_in() {
  return true;
}

std::vector<DeviceListing> list_devices() {
  return translated("Vulkan", "listing devices", [] {
    const Instance instance(false, nullptr);
    std::vector<DeviceListing> listings;
    for (const vk::raii::PhysicalDevice& device : instance.devices()) {
      const DeviceFacts facts = facts_of(device);
      listings.push_back({facts.name, std::string(kind_name(facts.kind)),
                          fmt::format("{}.{}", facts.major, facts.minor),
                          greatest_device_heap(device.getMemoryProperties()), refusal(facts)});
    }
    return listings;
  });
}

std::string device_name(const std::string& wanted) {
  return translated("Vulkan", "listing devices", [&] {
    const Instance instance(false, nullptr);
    return facts_of(choose(instance, wanted)).name;
  });
}

std::string hardware_device() {
  if (!has_device_file()) return "";
  try {
    return translated("Vulkan", "listing devices", [] {
      const Instance instance(false, nullptr);
      const std::vector<DeviceFacts> facts = facts_of_all(instance.devices());
      const std::optional<std::size_t> best = choose_hardware(facts);
      return best ? facts[*best].name : "";
    });
  } catch (const Unavailable&) {
    return "";
  }
}

std::shared_ptr<Machine> open_machine(const MachineOptions& options) {
  return translated("Vulkan", "opening the device", [&] { return std::make_shared<Machine>(options); });
}

std::string machine_name(const Machine& machine) {
  return machine.device().name();
}

DeviceWork work_of(const Machine& machine) {
  return machine.work();
}

}  // namespace gatelight::neural::vulkan
