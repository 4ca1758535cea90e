#pragma once

#include <array>

namespace gatelight::neural {

using Float2 = std::array<float, 2>;
using Float3 = std::array<float, 3>;

}  // namespace gatelight::neural
