#pragma once
// The device of the tests: one for the program, with every command validated.

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "base/errors.h"
#include "neural/vulkan/vulkan_backend.h"

namespace gatelight::neural::testing {

/// Messages of the validation layer about all machines of this program.
inline const std::shared_ptr<vulkan::ValidationMessages>& validation_messages() {
  static const auto messages = std::make_shared<vulkan::ValidationMessages>();
  return messages;
}

/// Returns null where there is no device (or no validation layer) and GATELIGHT_REQUIRE_VULKAN is not set.
inline std::shared_ptr<vulkan::Machine> open_test_machine(std::uint64_t longest_part = 0) {
  vulkan::MachineOptions options{
      .validate = true, .messages = validation_messages(), .longest_part = longest_part};
  if (const char* device = std::getenv("GATELIGHT_TEST_DEVICE")) options.device = device;
  try {
    return vulkan::open_machine(options);
  } catch (const Unavailable&) {
    if (std::getenv("GATELIGHT_REQUIRE_VULKAN") != nullptr) throw;
    return nullptr;
  }
}

/// Closes the device after the last test. At the end of the program the validation layer destroys its own
/// data first.
class MachineOwner : public ::testing::Environment {
 public:
  const std::shared_ptr<vulkan::Machine>& get() {
    if (!opened_) machine_ = open_test_machine();
    opened_ = true;
    return machine_;
  }
  void TearDown() override { machine_.reset(); }

 private:
  bool opened_ = false;
  std::shared_ptr<vulkan::Machine> machine_;
};

inline MachineOwner& machine_owner =
    static_cast<MachineOwner&>(*::testing::AddGlobalTestEnvironment(new MachineOwner));

inline const std::shared_ptr<vulkan::Machine>& test_machine() {
  return machine_owner.get();
}

/// Skips without a device; fails if the validation layer has reported a message by the end of the test.
class OnVulkan : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test_machine() == nullptr) GTEST_SKIP() << "no Vulkan device with a validation layer";
  }
  void TearDown() override {
    for (const std::string& message : validation_messages()->take()) ADD_FAILURE() << message;
  }
};

}  // namespace gatelight::neural::testing
