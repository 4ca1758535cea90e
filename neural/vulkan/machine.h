#pragma once
// The objects that backends share: the device, its messages, its compiled shaders.

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
  /// Must be called for each submission. Throws vk::DeviceLostError where GATELIGHT_VULKAN_LOSE_AFTER is
  /// reached.
  void count_submission();
  /// Whoever records commands counts them here.
  DeviceWork& work() { return work_; }
  const DeviceWork& work() const { return work_; }
  /// Throws ValidationFailed if the validation layer reported a message.
  void check() { instance_.check_messages(); }

 private:
  Instance instance_;
  Device device_;
  Pipelines pipelines_;
  std::uint64_t longest_part_;
  DeviceWork work_;
  std::uint64_t lose_after_;
};

}  // namespace gatelight::neural::vulkan
