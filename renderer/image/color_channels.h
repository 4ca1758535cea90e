#pragma once
// Which of a layer's channels are its colours, by their names: files hold them in any order, with others
// between.

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Where red, green and blue are among the layer's channels: R, G and B, or three times Y, which is grey.
/// Nothing where these names are not there (depth, X Y Z, colours that lack one).
std::optional<std::array<std::size_t, 3>> color_channels(const Layer& layer);

/// "channels A, Z, expected R, G and B, or Y": for messages about a layer without colours.
std::string describe_channels(const Layer& layer);

}  // namespace gatelight::renderer
