#pragma once
// A picture of a clear sky, and its sun, computed from the atmosphere (atmosphere.h).

#include "renderer/light/environment_picture.h"
#include "renderer/settings/sky_options.h"

namespace gatelight::renderer {

struct ClearSky {
  EnvironmentPicture picture;          ///< without the disc of the sun; the sun is above or below its centre
  Vec3 to_sun{0.0f, 0.0f, -1.0f};      ///< unit, in the picture's frame
  float sun_radius = 0.0f;             ///< radians; 0: the sun is a directional light
  Color sun_irradiance{0, 0, 0};       ///< on a plane that faces the sun; zero at night
  double sun_azimuth_degrees = 0.0;    ///< from north (-z), clockwise seen from above
  double sun_elevation_degrees = 0.0;  ///< above the horizon
};

/// Radiance in linear Rec. 709, in units of 100 000 lux / pi (daylight_spectrum.h): a white surface in full
/// daylight has about 1. All values are multiplied by `scale`. Parallel (oneTBB), with the same bits for any
/// number of threads.
ClearSky make_clear_sky(const SkyOptions& options, float scale);

}  // namespace gatelight::renderer
