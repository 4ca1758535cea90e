#pragma once
// What a device can do, measured: what benchmarks put their figures beside.

#include "neural/vulkan/vulkan_backend.h"

namespace gatelight::neural::vulkan {

struct MeasuredLimits {
  double operations_per_second = 0.0;  ///< fp32, a multiplication with an addition being two
  double bytes_per_second = 0.0;       ///< read in a row
};
/// Takes about a second, and `bytes` of memory. Zeros where the device has no timestamps.
MeasuredLimits measure_limits(Machine& machine, std::uint64_t bytes);

}  // namespace gatelight::neural::vulkan
