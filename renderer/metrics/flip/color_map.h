#pragma once

#include <array>

namespace gatelight::renderer::flip {

/// The colour map magma by N. Smith and S. van der Walt (CC0), in sRGB values in [0, 1], within 1/255 of the
/// table of 256 colours. `error` is in [0, 1].
std::array<float, 3> magma(float error);

}  // namespace gatelight::renderer::flip
