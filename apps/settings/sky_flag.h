#pragma once
// The value of --sky.

#include <string>

#include "renderer/settings/sky_options.h"

namespace gatelight::apps {

/// Reads "clear", or "turbidity=3, sun=AZIMUTH,ELEVATION, ground=0.2, size=0.53, intensity=1", with
/// "date=2026-06-21, time=14:30, place=LATITUDE,LONGITUDE, zone=+2" instead of the sun; each part may be left
/// out. Throws BadOption that names the option, the part and what was expected.
renderer::SkyOptions read_sky(const std::string& option, const std::string& text);

}  // namespace gatelight::apps
