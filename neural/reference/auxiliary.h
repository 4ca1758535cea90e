#pragma once
// The network inputs besides the feature vectors.

#include <vector>

#include "neural/reference/point.h"

namespace gatelight::neural::reference {

/// Returns (theta/pi, phi/2pi) with theta = atan2(|(x,y)|, z), which is well conditioned at the poles, and
/// phi = atan2(y, x). The second value is in [-1/2, 1/2].
std::array<double, 2> spherical(const std::array<double, 3>& direction);

/// Appends input_count(input) values.
void append_auxiliary(const AuxiliaryInput& input, const Point& point, std::vector<double>& inputs);

}  // namespace gatelight::neural::reference
