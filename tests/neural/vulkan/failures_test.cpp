// A device's failures become the library's exceptions, and leave states unchanged where possible.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "neural/vulkan/machine.h"
#include "tests/neural/vulkan/agreement.h"
#include "tests/support/messages.h"

namespace gatelight::neural {
namespace {

using namespace testing;
using tests::expect_message;
using tests::refusal;

// The names of devices, and so the messages, depend on the machine.
class VulkanFailures : public OnVulkan {};

TEST_F(VulkanFailures, ALostDeviceIsReportedByStepsAndAnswers) {
  const ModelCase c = find_model_case("nrc");
  const OwnedBatch batch = make_batch(*c.model, 50, 1);
  setenv("GATELIGHT_VULKAN_LOSE_AFTER", "2", 1);  // making the backend, and a step
  const auto machine = vulkan::open_machine({});
  unsetenv("GATELIGHT_VULKAN_LOSE_AFTER");
  const auto backend = vulkan::make_vulkan_backend(machine, c.model, {});
  EXPECT_EQ(backend->train(batch.training()).records, 50u);
  expect_message(refusal<DeviceLost>([&] { backend->train(batch.training()); }),
                 {vulkan::machine_name(*machine)});
  std::vector<float> out(batch.size() * 3);
  EXPECT_THROW(backend->query(batch.points(), {}, out), DeviceLost);
  EXPECT_THROW(backend->query(batch.points(), {}, out), DeviceLost);
}

// 2^31 nodes of 16 numbers are 128 GiB, and there are four such arrays: more than any device has.
TEST_F(VulkanFailures, TooLittleMemoryIsReportedWithTheDevice) {
  ModelConfig config = default_hash_config();
  config.hash_grid.levels = 1;
  config.hash_grid.features = 16;
  config.hash_grid.base_resolution = 1290;
  config.hash_grid.log2_table_size = 31;
  const auto model = make_model(config);
  expect_message(refusal<OutOfDeviceMemory>([&] { vulkan::make_vulkan_backend(test_machine(), model, {}); }),
                 {vulkan::machine_name(*test_machine()), "MiB"});
}

// A buffer of zero bytes is invalid, but harmless.
TEST_F(VulkanFailures, AMessageOfTheValidationLayerFailsTheNextStep) {
  vulkan::MachineOptions options{.validate = true,
                                 .messages = std::make_shared<vulkan::ValidationMessages>()};
  const auto machine = vulkan::open_machine(options);
  const ModelCase c = find_model_case("nrc");
  const OwnedBatch batch = make_batch(*c.model, 50, 1);
  const auto backend = vulkan::make_vulkan_backend(machine, c.model, {});
  EXPECT_EQ(backend->train(batch.training()).records, 50u);
  EXPECT_THAT(options.messages->take(), ::testing::IsEmpty());
  {
    const vk::BufferCreateInfo nothing({}, 0, vk::BufferUsageFlagBits::eStorageBuffer);
    const vk::raii::Buffer buffer(machine->device().handle(), nothing);
  }
  expect_message(refusal<vulkan::ValidationFailed>([&] { backend->train(batch.training()); }),
                 {"VUID-VkBufferCreateInfo-size-00912"});
}

}  // namespace
}  // namespace gatelight::neural
