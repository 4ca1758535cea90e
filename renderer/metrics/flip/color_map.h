#pragma once

#include <array>

namespace gatelight::renderer::flip {

/// The map magma by N. Smith and S. van der Walt (CC0), as bytes over 255 (sRGB), within 1/255 of the table
/// of 256 colours. `error` in [0, 1].
std::array<float, 3> magma(float error);

}  // namespace gatelight::renderer::flip
