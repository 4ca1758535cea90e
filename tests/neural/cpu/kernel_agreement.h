#pragma once
// The kernels of every instruction set, compared with the reference.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/agreement.h"

namespace gatelight::neural::testing {

/// Sizes around the kernels' 16, 8 and 1 lanes and tiles of 48, with primes between them.
inline std::size_t small_size(std::uint64_t seed) {
  constexpr std::size_t kSizes[] = {1,  2,  15, 16, 17,  31,  47, 48, 49, 61,
                                    95, 96, 97, 97, 127, 149, 7,  11, 23, 33};
  return kSizes[seed % std::size(kSizes)];
}

/// Prints the worst differences at the end of a suite.
class AgreesOnKernels : public ::testing::Test {
 protected:
  static void TearDownTestSuite() { agreement_.reset(); }

  static Agreement& agreement() {
    const auto kernels = [](const std::shared_ptr<const Model>& model, const TrainingOptions& options) {
      std::vector<NamedBackend> backends;
      for (const simd::Isa isa : simd::available_isas())
        backends.push_back({std::string(isa_name(isa)), cpu::make_cpu_backend(model, options, isa)});
      return backends;
    };
    if (agreement_ == nullptr) agreement_ = std::make_unique<Agreement>(kernels, true);
    return *agreement_;
  }

 private:
  static inline std::unique_ptr<Agreement> agreement_;
};

}  // namespace gatelight::neural::testing
