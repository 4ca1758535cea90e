#pragma once
// The position of the sun at a time and a place.

#include "renderer/settings/sky_options.h"

namespace gatelight::renderer {

struct SolarPosition {
  double azimuth_degrees = 0.0;    ///< from north, clockwise seen from above, in [0, 360)
  double elevation_degrees = 0.0;  ///< of the centre, above the horizon; without refraction
};

/// The low-precision position of Meeus, "Astronomical Algorithms" (1998), chapters 7, 12, 13 and 25, as in
/// NOAA's solar calculator: within 0.01 degrees between 1900 and 2100. Seen from the earth's centre.
SolarPosition solar_position(const SunTime& time);

}  // namespace gatelight::renderer
