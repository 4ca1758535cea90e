#pragma once

#include <optional>
#include <string>

namespace gatelight::renderer {

/// A moment and a place on earth, from which the sun's position follows.
struct SunTime {
  int year = 2026;
  int month = 6;                   ///< 1 to 12
  int day = 21;                    ///< 1 to 31
  int second_of_day = 43200;       ///< of the clock
  double zone_hours = 0.0;         ///< of the clock, ahead of UTC (with summer time)
  double latitude_degrees = 0.0;   ///< north is positive
  double longitude_degrees = 0.0;  ///< east is positive

  bool operator==(const SunTime&) const = default;
};

/// A clear sky (light/clear_sky.h). North is -z, east is +x, up is +y.
struct SkyOptions {
  float turbidity = 3.0f;               ///< 1: no haze, 2 to 3: clear, 10: hazy
  float sun_azimuth_degrees = 135.0f;   ///< from north, clockwise seen from above
  float sun_elevation_degrees = 40.0f;  ///< above the horizon
  std::optional<SunTime> time;          ///< instead of azimuth and elevation
  float ground = 0.2f;                  ///< albedo below the horizon
  float sun_size_degrees = 0.53f;       ///< diameter of the disc; 0: a directional light
  float intensity = 1.0f;               ///< multiplies sky and sun

  bool operator==(const SkyOptions&) const = default;
};

/// All parts as a text, such as "turbidity=3,sun=135,40,ground=0.2,size=0.53,intensity=1".
std::string text_of(const SkyOptions& sky);

}  // namespace gatelight::renderer
