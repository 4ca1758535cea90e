#pragma once
// Checks that the Vulkan backend agrees with the reference.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/neural/vulkan/device.h"
#include "tests/support/agreement.h"

namespace gatelight::neural::testing {

/// Compares the device with the reference, by the tolerances of the CPU's kernels, which add in another
/// order. Prints the worst differences at the end of a suite.
class AgreesOnVulkan : public OnVulkan {
 protected:
  static void TearDownTestSuite() { agreement_.reset(); }

  static Agreement& agreement() {
    const auto device = [](const std::shared_ptr<const Model>& model, const TrainingOptions& options) {
      std::vector<NamedBackend> backends;
      backends.push_back({"vulkan", vulkan::make_vulkan_backend(test_machine(), model, options)});
      return backends;
    };
    if (agreement_ == nullptr) agreement_ = std::make_unique<Agreement>(device, false);
    return *agreement_;
  }

 private:
  static inline std::unique_ptr<Agreement> agreement_;
};

}  // namespace gatelight::neural::testing
