#include "renderer/settings/sky_options.h"

#include <fmt/format.h>

namespace gatelight::renderer {

std::string text_of(const SkyOptions& sky) {
  std::string sun = fmt::format("sun={},{}", sky.sun_azimuth_degrees, sky.sun_elevation_degrees);
  if (const auto& t = sky.time) {
    const int second = t->second_of_day;
    sun = fmt::format("date={:04}-{:02}-{:02},time={:02}:{:02}:{:02},place={},{},zone={}", t->year, t->month,
                      t->day, second / 3600, second / 60 % 60, second % 60, t->latitude_degrees,
                      t->longitude_degrees, t->zone_hours);
  }
  return fmt::format("turbidity={},{},ground={},size={},intensity={}", sky.turbidity, sun, sky.ground,
                     sky.sun_size_degrees, sky.intensity);
}

}  // namespace gatelight::renderer
