#pragma once
// Measured peak rates of a device, for comparison with benchmarks.

#include "neural/vulkan/vulkan_backend.h"

namespace gatelight::neural::vulkan {

struct MeasuredLimits {
  double operations_per_second = 0.0;  ///< fp32; a fused multiply-add counts as two
  double bytes_per_second = 0.0;       ///< sequential reads
};
/// Takes about a second and `bytes` of memory. Returns zeros if the device has no timestamps.
MeasuredLimits measure_limits(Machine& machine, std::uint64_t bytes);

}  // namespace gatelight::neural::vulkan
