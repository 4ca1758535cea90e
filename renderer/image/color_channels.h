#pragma once
// Finds a layer's colour channels by their names. Files hold channels in any order, with others between.

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// The indices of R, G and B among the layer's channels, or three times the index of Y for a grey layer.
/// Empty for other layers (depth, X Y Z, an incomplete colour).
std::optional<std::array<std::size_t, 3>> color_channels(const Layer& layer);

/// The indices of X, Y and Z, or of R, G and B.
std::optional<std::array<std::size_t, 3>> vector_channels(const Layer& layer);

/// Text for messages about a layer without colours: "channels A, Z, expected R, G and B, or Y".
std::string describe_channels(const Layer& layer);

}  // namespace gatelight::renderer
