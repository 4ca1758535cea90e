#pragma once
// What backends share: the device, its messages, its compiled shaders.

#include "neural/vulkan/devices.h"
#include "neural/vulkan/instance.h"
#include "neural/vulkan/pipelines.h"

namespace gatelight::neural::vulkan {

class Machine {
 public:
  explicit Machine(const MachineOptions& options);

  const Device& device() const { return device_; }
  Pipelines& pipelines() { return pipelines_; }
  std::uint64_t longest_part() const { return longest_part_; }
  /// Called for all work that is handed to the device. Throws vk::DeviceLostError
  /// (MachineOptions::lose_after).
  void count_submission();
  /// Throws ValidationFailed where the validation layer said something.
  void check() { instance_.check_messages(); }

 private:
  Instance instance_;
  Device device_;
  Pipelines pipelines_;
  std::uint64_t longest_part_;
  std::uint64_t submissions_ = 0, lose_after_;
};

}  // namespace gatelight::neural::vulkan
