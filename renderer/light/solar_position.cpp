#include "renderer/light/solar_position.h"

#include <cmath>

namespace gatelight::renderer {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// The Julian day at 0h UTC of a date of the Gregorian calendar (Meeus, equation 7.1).
double julian_day(int year, int month, int day) {
  if (month <= 2) {
    year -= 1;
    month += 12;
  }
  const double century = std::floor(year / 100.0);
  const double gregorian = 2.0 - century + std::floor(century / 4.0);
  return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + day + gregorian - 1524.5;
}

double turn_of(double degrees) {
  return degrees - 360.0 * std::floor(degrees / 360.0);
}

}  // namespace

SolarPosition solar_position(const SunTime& time) {
  const double hours = time.second_of_day / 3600.0 - time.zone_hours;
  const double days = julian_day(time.year, time.month, time.day) + hours / 24.0 - 2451545.0;  // since J2000
  const double t = days / 36525.0;

  // The apparent longitude of the sun (chapter 25).
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * kDegree;
  const double centre = std::sin(anomaly) * (1.914602 - t * (0.004817 + t * 0.000014)) +
                        std::sin(2.0 * anomaly) * (0.019993 - t * 0.000101) +
                        std::sin(3.0 * anomaly) * 0.000289;
  const double node = (125.04 - 1934.136 * t) * kDegree;
  const double longitude = (mean_longitude + centre - 0.00569 - 0.00478 * std::sin(node)) * kDegree;
  const double obliquity = (23.439291 - 0.0130042 * t + 0.00256 * std::cos(node)) * kDegree;

  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));

  // Sidereal time (equation 12.4) gives the hour angle, positive after noon (chapter 13).
  const double sidereal = 280.46061837 + 360.98564736629 * days + t * t * 0.000387933;
  const double hour_angle = turn_of(sidereal + time.longitude_degrees - right_ascension / kDegree) * kDegree;
  const double latitude = time.latitude_degrees * kDegree;
  const double sine = std::sin(latitude) * std::sin(declination) +
                      std::cos(latitude) * std::cos(declination) * std::cos(hour_angle);
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north = std::cos(latitude) * std::sin(declination) -
                       std::sin(latitude) * std::cos(declination) * std::cos(hour_angle);
  return {turn_of(std::atan2(east, north) / kDegree), std::atan2(sine, std::hypot(east, north)) / kDegree};
}

}  // namespace gatelight::renderer
