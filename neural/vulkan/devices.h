#pragma once
// The devices that Vulkan offers. Free of Vulkan's own headers, and there in builds without Vulkan too, where
// everything but is_built_in throws Unavailable.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gatelight::neural::vulkan {

bool is_built_in();

struct DeviceListing {
  std::string name;
  std::string kind;     ///< discrete, integrated, virtual, software or other
  std::string version;  ///< of Vulkan, "1.3"
  std::uint64_t memory_bytes = 0;
  std::string refusal;  ///< why it cannot be used; empty where it can
};

/// In the order of their indices. Empty where there is a loader and no device. Throws Unavailable without a
/// loader.
std::vector<DeviceListing> list_devices();

/// The name of the device that open_machine would use (MachineOptions::device). Throws as it does.
std::string device_name(const std::string& wanted);

struct MachineOptions {
  /// Index, or part of a name in any case; empty: the first usable one of the best kind.
  std::string device;
  /// Every command is checked by the Khronos layer, and a message of it is an error (ValidationFailed).
  /// Always so where the environment variable GATELIGHT_VULKAN_VALIDATION is set and not 0.
  bool validate = false;
  /// The layer's messages, also those that come while things are destroyed.
  std::shared_ptr<std::vector<std::string>> messages = nullptr;
  /// For tests: as if the device were lost when so much work has been handed to it; 0: never. Otherwise as
  /// the environment variable GATELIGHT_VULKAN_LOSE_AFTER says.
  std::uint64_t lose_after = 0;
  /// Arrays by node are cut into parts of at most so many bytes; 0: what the device can have in one piece.
  std::uint64_t longest_part = 0;
};

/// A device and its compiled shaders. Backends may share one; then one thread uses them all.
class Machine;

/// Throws Unavailable: no loader, no such device, or one that lacks what is needed.
std::shared_ptr<Machine> open_machine(const MachineOptions& options);

std::string machine_name(const Machine& machine);

}  // namespace gatelight::neural::vulkan
