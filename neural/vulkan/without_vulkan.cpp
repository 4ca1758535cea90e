// Replaces this folder's sources in builds without Vulkan.

#include "base/errors.h"
#include "neural/vulkan/vulkan_backend.h"

namespace gatelight::neural::vulkan {

namespace {

[[noreturn]] void refuse() {
  throw Unavailable("this program was built without Vulkan (GATELIGHT_VULKAN)");
}

}  // namespace

bool is_built_in() {
  return false;
}

std::vector<DeviceListing> list_devices() {
  refuse();
}

std::string device_name(const std::string&) {
  refuse();
}

std::string hardware_device() {
  return "";
}

std::shared_ptr<Machine> open_machine(const MachineOptions&) {
  refuse();
}

std::string machine_name(const Machine&) {
  refuse();
}

DeviceWork work_of(const Machine&) {
  refuse();
}

// NOLINTNEXTLINE(performance-unnecessary-value-param): with Vulkan they are kept
std::unique_ptr<Backend> make_vulkan_backend(std::shared_ptr<Machine>, std::shared_ptr<const Model>,
                                             const TrainingOptions&) {
  refuse();
}

}  // namespace gatelight::neural::vulkan
