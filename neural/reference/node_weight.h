#pragma once
// A feature vector that a point's encoding reads, and its share in the interpolation.

#include <cstdint>

namespace gatelight::neural::reference {

struct NodeWeight {
  std::uint32_t node = 0;
  double weight = 0;
};

}  // namespace gatelight::neural::reference
