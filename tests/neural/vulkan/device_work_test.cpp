// What a machine counts of the work of its backends.

#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanDeviceWork : public OnVulkan {};

vulkan::DeviceWork work_since(const vulkan::DeviceWork& before) {
  const vulkan::DeviceWork now = vulkan::work_of(*test_machine());
  return {now.submissions - before.submissions, now.dispatches - before.dispatches,
          now.barriers - before.barriers, now.bytes_to_device - before.bytes_to_device,
          now.bytes_from_device - before.bytes_from_device};
}

// A point has 4 bytes each for surface and triangle and 8 for barycentrics; nrc adds 12 for the direction.
TEST_F(VulkanDeviceWork, OfAQueryIsWhatTheModelReads) {
  constexpr std::size_t kPoints = 500;
  for (const auto& [name, bytes] : {std::pair{"nrc", 28u}, {"nao", 16u}}) {
    const ModelCase c = find_model_case(name);
    const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, {});
    const OwnedBatch batch = make_batch(*c.model, kPoints, 3);
    const vulkan::DeviceWork before = vulkan::work_of(*test_machine());
    answers(*device, *c.model, batch, {QueryPrecision::fp32, OutputRange::raw, false});
    const vulkan::DeviceWork work = work_since(before);
    EXPECT_EQ(work.submissions, 1u);
    EXPECT_GE(work.bytes_to_device, kPoints * bytes);
    EXPECT_LT(work.bytes_to_device, kPoints * bytes + 512) << "the batch's block";
    EXPECT_EQ(work.bytes_from_device, 4 * kPoints * c.model->config.mlp.outputs);
  }
}

TEST_F(VulkanDeviceWork, OfStepsOfOneSizeIsTheSame) {
  const ModelCase c = find_model_case("nrc");
  const auto device = vulkan::make_vulkan_backend(test_machine(), c.model, {});
  const OwnedBatch batch = make_batch(*c.model, 100, 3);
  device->train(batch.training());  // sets the output bias, too
  std::vector<vulkan::DeviceWork> steps;
  for (int i = 0; i < 2; ++i) {
    const vulkan::DeviceWork before = vulkan::work_of(*test_machine());
    device->train(batch.training());
    steps.push_back(work_since(before));
  }
  EXPECT_EQ(steps[0].submissions, 1u);
  EXPECT_GT(steps[0].dispatches, 0u);
  EXPECT_GT(steps[0].barriers, 0u);
  EXPECT_EQ(steps[0].dispatches, steps[1].dispatches);
  EXPECT_EQ(steps[0].barriers, steps[1].barriers);
  EXPECT_EQ(steps[0].bytes_to_device, steps[1].bytes_to_device);
  EXPECT_EQ(steps[0].bytes_from_device, steps[1].bytes_from_device);
}

}  // namespace
}  // namespace gatelight::neural
