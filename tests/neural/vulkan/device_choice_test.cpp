// Which device is taken, and what is said of the others: no device is needed for it.

#include "neural/vulkan/device_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "neural/base/errors.h"

namespace gatelight::neural::vulkan {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

DeviceFacts usable(const char* name, DeviceKind kind) {
  return {name, kind, 1, 3, true, true, 1024, 32768};
}

std::string refusal_of_choice(const std::vector<DeviceFacts>& devices, const char* wanted) {
  try {
    choose_device(devices, wanted);
  } catch (const Unavailable& error) {
    return error.what();
  }
  return "";
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
  EXPECT_THAT(
      refusal_of_choice(devices, ""),
      AllOf(HasSubstr("llvmpipe (software, refused: has 8192 bytes"), HasSubstr("lacks bufferDeviceAddress"),
            HasSubstr("has Vulkan 1.1"), HasSubstr("no compute queue")));
}

TEST(DeviceChoice, AnIndexOrPartOfANameNamesADevice) {
  const std::vector<DeviceFacts> devices = {usable("NVIDIA H200", DeviceKind::discrete),
                                            usable("llvmpipe (LLVM 15)", DeviceKind::software)};
  EXPECT_EQ(choose_device(devices, "1"), 1u);
  EXPECT_EQ(choose_device(devices, "LLVMPipe"), 1u);
  EXPECT_EQ(choose_device(devices, "nvidia"), 0u);
  EXPECT_THAT(refusal_of_choice(devices, "2"), AllOf(HasSubstr("device 2"), HasSubstr("1: llvmpipe")));
  EXPECT_THAT(refusal_of_choice(devices, "radeon"),
              AllOf(HasSubstr("'radeon'"), HasSubstr("0: NVIDIA H200")));
}

TEST(DeviceChoice, ANamedDeviceThatCannotBeUsedIsRefusedWithItsReason) {
  std::vector<DeviceFacts> devices = {usable("old H200", DeviceKind::discrete),
                                      usable("H200", DeviceKind::discrete)};
  devices[0].workgroup_threads = 64;
  EXPECT_THAT(refusal_of_choice(devices, "0"), AllOf(HasSubstr("old H200"), HasSubstr("64 threads")));
  EXPECT_EQ(choose_device(devices, "h200"), 1u);
  EXPECT_THAT(refusal_of_choice(devices, "old"), HasSubstr("64 threads"));
}

TEST(DeviceChoice, NoDeviceAtAllIsSaid) {
  EXPECT_THAT(refusal_of_choice({}, ""), HasSubstr("no Vulkan device was found"));
  EXPECT_THAT(refusal_of_choice({}, "0"), HasSubstr("no Vulkan device was found"));
}

}  // namespace
}  // namespace gatelight::neural::vulkan
