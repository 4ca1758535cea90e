#pragma once

#include <cstdint>
#include <vector>

namespace gatelight::neural {

/// Each value becomes the sum of itself and all before it. In parallel.
void inclusive_prefix_sum(std::vector<std::uint32_t>& values);

}  // namespace gatelight::neural
