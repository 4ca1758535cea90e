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

/// The beauty layer, rows from the top: R, G, B of each pixel as the display's code values in [0, 1], sRGB
/// without OpenColorIO. A fourth value is the alpha where the layer has one; the colours are then those
/// without it (straight alpha). A layer of one channel is grey. Throws BadOption for a view that the
/// configuration has not, MissingLibrary where OpenColorIO is needed and cannot be loaded.
std::vector<float> displayed(const Picture& picture, const DisplayOptions& options);

/// Throws what displayed() would, before there is a picture.
void check_display(const DisplayOptions& options);

}  // namespace gatelight::renderer
