#pragma once
// A picture as a screen shows it.

#include <vector>

#include "renderer/image/ocio_view.h"
#include "renderer/image/picture.h"
#include "renderer/image/tonemap.h"

namespace gatelight::renderer {

struct DisplayOptions {
  float exposure = 0.0f;  ///< in stops
  float white_balance = kDaylightKelvin;
  Tonemap tonemap = Tonemap::none;
  OcioView ocio;  ///< replaces the curve and sRGB
};

/// Converts the beauty layer to display values in [0, 1]: R, G, B of each pixel, rows from the top, sRGB
/// unless OpenColorIO is used. If the layer has an alpha, it follows as a fourth value, and the colours are
/// no longer multiplied by it (straight alpha). A layer of one channel becomes grey. Throws BadOption if the
/// configuration does not have the view, MissingLibrary if OpenColorIO is needed and cannot be loaded.
std::vector<float> displayed(const Picture& picture, const DisplayOptions& options);

/// Throws what displayed() would throw. Call it before rendering.
void check_display(const DisplayOptions& options);

}  // namespace gatelight::renderer
