// The measured rates of a device, with which benchmarks compare, are plausible.

#include "neural/vulkan/measured_limits.h"

#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

class VulkanLimits : public testing::OnVulkan {};

TEST_F(VulkanLimits, LieBetweenASlowCoreAndAHundredTimesTheFastestDevice) {
  const vulkan::MeasuredLimits limits = vulkan::measure_limits(*testing::test_machine(), 16u << 20);
  // From one slow core to a hundred times the fastest device there is.
  EXPECT_GT(limits.operations_per_second, 1e6);
  EXPECT_LT(limits.operations_per_second, 1e17);
  EXPECT_GT(limits.bytes_per_second, 1e6);
  EXPECT_LT(limits.bytes_per_second, 1e15);
}

}  // namespace
}  // namespace gatelight::neural
