#pragma once
// The exposure that suits a picture.

#include <optional>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// In stops, to a tenth: brings the log-average of the luminance to a middle grey of 0.18 (Reinhard et al.
/// 2002, equation 1), but the pixel that 88 % do not exceed to at most 0.75, and the one that 98 % do not
/// exceed to at most 12, so that sunlit floors, sky and windows keep their shades. Black pixels do not count.
/// 0 for a picture without light.
float auto_exposure(const Picture& picture);

/// The same; nothing for a picture without light.
std::optional<float> exposure_of_light(const Picture& picture);

}  // namespace gatelight::renderer
