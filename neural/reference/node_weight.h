#pragma once
// A node that a point's encoding reads, and its weight in the interpolation.

#include <cstdint>

namespace gatelight::neural::reference {

struct NodeWeight {
  std::uint32_t node = 0;
  double weight = 0;
};

}  // namespace gatelight::neural::reference
