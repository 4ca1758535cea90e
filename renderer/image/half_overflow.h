#pragma once
// Values of a picture that a half cannot hold.

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

struct HalfOverflow {
  std::string layer;  ///< empty for the beauty layer
  std::size_t values = 0;
};

/// The layers with finite values beyond 65504, of those that an EXR of halves stores as half: write_image()
/// writes such values as 65504 with their sign.
std::vector<HalfOverflow> half_overflows(const Picture& picture);

}  // namespace gatelight::renderer
