#pragma once
// The available Vulkan devices. This header includes no Vulkan header. It also exists in builds without
// Vulkan, where all functions except is_built_in and hardware_device throw Unavailable.

#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gatelight::neural::vulkan {

bool is_built_in();

struct DeviceListing {
  std::string name;
  std::string kind;     ///< discrete, integrated, virtual, software or other
  std::string version;  ///< Vulkan version, for example "1.3"
  std::uint64_t memory_bytes = 0;
  std::string refusal;  ///< the reason why it cannot be used; empty if it can
};

/// Lists the devices in the order of their indices. Empty if there is a loader but no device. Throws
/// Unavailable without a loader.
std::vector<DeviceListing> list_devices();

/// The name of the device that open_machine would use for MachineOptions::device. Throws Unavailable as it
/// does.
std::string device_name(const std::string& wanted);

/// The name of the best usable device that is hardware; empty if there is none. Opens the loader only where
/// the system has a graphics device.
std::string hardware_device();

/// Vulkan's validation layer found a mistake of the program.
struct ValidationFailed : std::logic_error {
  using std::logic_error::logic_error;
};

/// What the layer reports, from any thread.
class ValidationMessages {
 public:
  void add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
  }
  /// The messages since the last call.
  std::vector<std::string> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> messages_;
};

struct MachineOptions {
  /// Index, or part of a name, ignoring case. Empty means the first usable device of the best kind.
  std::string device;
  /// The Khronos layer checks every command, and each of its messages is an error (ValidationFailed). The
  /// environment variable GATELIGHT_VULKAN_VALIDATION also enables this if it is set and not 0.
  bool validate = false;
  /// Receives the layer's messages, including those during destruction; may be null.
  std::shared_ptr<ValidationMessages> messages = nullptr;
  /// Maximum bytes of a part of the arrays by node; 0 means the device's maximum.
  std::uint64_t longest_part = 0;
};

/// A device and its compiled shaders. Backends may share a machine if only one thread uses them all.
class Machine;

/// Throws Unavailable if there is no loader, no such device, or the device lacks a needed feature.
std::shared_ptr<Machine> open_machine(const MachineOptions& options);

std::string machine_name(const Machine& machine);

/// What the steps and queries of a machine's backends had the device do. Copies of states are not counted.
struct DeviceWork {
  std::uint64_t submissions = 0, dispatches = 0, barriers = 0;
  std::uint64_t bytes_to_device = 0, bytes_from_device = 0;
};
/// Sums since the machine was opened.
DeviceWork work_of(const Machine& machine);

}  // namespace gatelight::neural::vulkan
