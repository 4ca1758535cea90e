#pragma once

#include <cstdint>
#include <vector>

namespace gatelight::neural {

/// Replaces each value by the sum of itself and all values before it, in parallel.
void inclusive_prefix_sum(std::vector<std::uint32_t>& values);

}  // namespace gatelight::neural
