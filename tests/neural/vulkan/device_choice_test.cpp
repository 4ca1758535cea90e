// The choice of a device and the messages about the others. No device is needed.

#include "neural/vulkan/device_choice.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::neural::vulkan {
namespace {

DeviceFacts usable(const char* name, DeviceKind kind) {
  return {name, kind, 1, 3, true, true, 1024, 32768};
}

void expect_refused(const std::vector<DeviceFacts>& devices, const char* wanted,
                    const tests::NameList& names) {
  tests::expect_refusal<Unavailable>([&] { choose_device(devices, wanted); }, names);
}

TEST(DeviceChoice, TheBestKindThatCanBeUsedIsTaken) {
  std::vector<DeviceFacts> devices = {
      usable("llvmpipe", DeviceKind::software), usable("Arc", DeviceKind::integrated),
      usable("H200", DeviceKind::discrete), usable("H100", DeviceKind::discrete)};
  EXPECT_EQ(choose_device(devices, ""), 2u);
  devices[2].buffer_addresses = false;
  EXPECT_EQ(choose_device(devices, ""), 3u);
  devices[3].minor = 1;
  EXPECT_EQ(choose_device(devices, ""), 1u);
  devices[1].compute_queue = false;
  EXPECT_EQ(choose_device(devices, ""), 0u);
  devices[0].shared_bytes = 8192;
  expect_refused(devices, "",
                 {"llvmpipe", "8192 bytes", "Arc", "H200", "bufferDeviceAddress", "H100", "Vulkan 1.1"});
}

TEST(DeviceChoice, SoftwareIsNotHardware) {
  std::vector<DeviceFacts> devices = {usable("llvmpipe", DeviceKind::software),
                                      usable("mystery", DeviceKind::other)};
  EXPECT_EQ(choose_hardware({}), std::nullopt);
  EXPECT_EQ(choose_hardware(devices), std::nullopt);
  devices.push_back(usable("Arc", DeviceKind::integrated));
  EXPECT_EQ(choose_hardware(devices), 2u);
  devices[2].shared_bytes = 8192;
  EXPECT_EQ(choose_hardware(devices), std::nullopt);
}

TEST(DeviceChoice, AnIndexOrPartOfANameNamesADevice) {
  const std::vector<DeviceFacts> devices = {usable("NVIDIA H200", DeviceKind::discrete),
                                            usable("llvmpipe (LLVM 15)", DeviceKind::software)};
  EXPECT_EQ(choose_device(devices, "1"), 1u);
  EXPECT_EQ(choose_device(devices, "LLVMPipe"), 1u);
  EXPECT_EQ(choose_device(devices, "nvidia"), 0u);
  expect_refused(devices, "2", {"device 2", "0: NVIDIA H200", "1: llvmpipe"});
  expect_refused(devices, "radeon", {"radeon", "0: NVIDIA H200", "1: llvmpipe"});
}

TEST(DeviceChoice, ANamedDeviceThatCannotBeUsedIsRefusedWithItsReason) {
  std::vector<DeviceFacts> devices = {usable("old H200", DeviceKind::discrete),
                                      usable("H200", DeviceKind::discrete)};
  devices[0].workgroup_threads = 64;
  expect_refused(devices, "0", {"old H200", "64 threads"});
  EXPECT_EQ(choose_device(devices, "h200"), 1u);
  expect_refused(devices, "old", {"old H200", "64 threads"});
}

TEST(DeviceChoice, AMissingDeviceIsReported) {
  expect_refused({}, "", {"Vulkan"});
  expect_refused({}, "0", {"Vulkan"});
}

}  // namespace
}  // namespace gatelight::neural::vulkan
