#pragma once
// Pictures as a screen shows them.

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"
#include "renderer/metrics/flip/planes.h"

namespace gatelight::renderer::flip {

/// Radiance. Negative values, which no screen shows, become 0. Throws CompareError for a picture without a
/// beauty layer, without pixels or with values that are not finite; `measure` is what is defined for finite
/// ones.
RgbPlanes read_planes(const NamedPicture& named, const char* measure);

/// Times 2^exposure, through the curve, cut to [0, 1]: linear light. Throws as read_planes().
RgbPlanes read_shown(const NamedPicture& named, const char* measure, float exposure, Tonemap tonemap);

}  // namespace gatelight::renderer::flip
