#include "renderer/light/atmosphere.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace gatelight::renderer {
namespace {

constexpr double kOzoneColumn = 0.3;  ///< centimetres at standard pressure: 300 Dobson units
constexpr float kHazeAlbedo = 0.9f;   ///< the part of the haze's extinction that is scattering
constexpr float kHazeForward = 0.76f;
constexpr float kEvenPhase = 0.25f * kInvPi;

constexpr int kViewSteps = 32;  ///< along a view
// The table of repeated scattering, by height and the sun's cosine.
constexpr int kRepeatedHeights = 16, kRepeatedSuns = 32;
constexpr int kRings = 8, kSpokes = 8;  ///< directions of an entry
constexpr int kRepeatedSteps = 16;
constexpr double kLowestSun = -0.45;  ///< signed root of the cosine: 11.7 degrees below the horizon

/// Per steradian, by the cosine of the angle from the direction of flight.
float rayleigh_phase(float cosine) {
  return 3.0f / (16.0f * kPi) * (1.0f + cosine * cosine);
}

/// Cornette and Shanks 1992, "Physically reasonable analytic expression for the single-scattering phase
/// function".
float haze_phase(float cosine) {
  constexpr float g = kHazeForward;
  const float base = 1.0f + g * g - 2.0f * g * cosine;
  return 3.0f / (8.0f * kPi) * (1.0f - g * g) * (1.0f + cosine * cosine) /
         ((2.0f + g * g) * base * std::sqrt(base));
}

double height_of(int i) {
  const double t = static_cast<double>(i) / (kRepeatedHeights - 1);
  return kAtmosphereHeight * t * t;
}
double sun_of(int j) {
  const double t = kLowestSun + (1.0 - kLowestSun) * j / (kRepeatedSuns - 1);
  return t * std::abs(t);
}

}  // namespace

Atmosphere::Atmosphere(float turbidity, float ground)
    :  // The vertical optical depth of air: Hansen and Travis 1974, "Light Scattering in Planetary
       // Atmospheres", equation 2.30.
      air_(make_spectrum([](double nm) {
        const double um2 = nm * nm * 1e-6;
        return 0.008569 / (um2 * um2) * (1.0 + 0.0113 / um2 + 0.00013 / (um2 * um2)) / kAirScale;
      })),
      haze_(make_spectrum([&](double nm) {
        const double beta = 0.04608 * static_cast<double>(turbidity) - 0.04586;
        return beta * std::pow(nm * 1e-3, -1.3) / kHazeScale;
      })),
      // The profile is a triangle: its area is its peak times its reach.
      ozone_(ozone_absorption() * static_cast<float>(kOzoneColumn / kOzoneReach)),
      repeated_(std::size_t{kRepeatedHeights} * kRepeatedSuns) {
  tbb::parallel_for(0, kRepeatedHeights * kRepeatedSuns, [&](int i) {
    repeated_[static_cast<std::size_t>(i)] =
        compute_repeated(kEarthRadius + height_of(i / kRepeatedSuns), sun_of(i % kRepeatedSuns), ground);
  });
}

Spectrum Atmosphere::compute_repeated(double radius, double cos_sun, float ground) const {
  const double sin_sun = std::sqrt(std::max(0.0, 1.0 - cos_sun * cos_sun));
  Spectrum second = Spectrum::Zero();  // scattered twice, or by the ground and then here
  Spectrum again = Spectrum::Zero();   // the part of scattered light that is scattered here again
  for (int i = 0; i < kRings * kSpokes; ++i) {
    const double up = 1.0 - 2.0 * (i / kSpokes + 0.5) / kRings;
    const double phi = 2.0 * M_PI * (i % kSpokes + 0.5) / kSpokes;
    const double cosine = up * cos_sun + std::sqrt(1.0 - up * up) * std::cos(phi) * sin_sun;
    const double to_ground = distance_to_ground(radius, up);
    const double distance = to_ground >= 0.0 ? to_ground : distance_to_top(radius, up);
    const auto sun_at = [&](double along, double there) {
      return (radius * cos_sun + along * cosine) / there;
    };
    AirAmounts seen, lit;
    const double step = distance / kRepeatedSteps;
    for (int k = 0; k < kRepeatedSteps; ++k) {
      const double along = (k + 0.5) * step;
      const double there = radius_along(radius, up, along);
      const AirAmounts here = densities_at(there - kEarthRadius);
      const auto length = static_cast<float>(step);
      const AirAmounts middle = seen.plus(here, 0.5f * length);
      seen = seen.plus(here, length);
      const Spectrum scattered =
          (here.air * air_ + here.haze * kHazeAlbedo * haze_) * transmittance(middle) * length;
      again += scattered;
      if (columns_.to_space(there, sun_at(along, there), lit))
        second += scattered * transmittance(lit) * kEvenPhase;
    }
    if (to_ground < 0.0) continue;
    const double sun = sun_at(distance, kEarthRadius);
    if (sun > 0.0 && columns_.to_space(kEarthRadius, sun, lit))
      second += transmittance(seen.plus(lit)) * (ground * kInvPi * static_cast<float>(sun));
  }
  // Means over the sphere: the integral with the even phase function.
  constexpr float kShare = 1.0f / (kRings * kSpokes);
  return second * kShare / (1.0f - again * kShare);
}

Spectrum Atmosphere::repeated(double radius, double cos_sun) const {
  const double x =
      std::sqrt(std::clamp((radius - kEarthRadius) / kAtmosphereHeight, 0.0, 1.0)) * (kRepeatedHeights - 1);
  const double root = std::copysign(std::sqrt(std::abs(cos_sun)), cos_sun);
  const double y = std::clamp((root - kLowestSun) / (1.0 - kLowestSun), 0.0, 1.0) * (kRepeatedSuns - 1);
  const int i = std::min(static_cast<int>(x), kRepeatedHeights - 2);
  const int j = std::min(static_cast<int>(y), kRepeatedSuns - 2);
  const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
  const Spectrum* at = repeated_.data() + static_cast<std::ptrdiff_t>(i) * kRepeatedSuns + j;
  return (1.0f - s) * ((1.0f - t) * at[0] + t * at[1]) +
         s * ((1.0f - t) * at[kRepeatedSuns] + t * at[kRepeatedSuns + 1]);
}

Spectrum Atmosphere::sky_radiance(const Vec3& direction, const Vec3& to_sun) const {
  const float cosine = direction.dot(to_sun);
  const Spectrum by_air = rayleigh_phase(cosine) * air_;
  const Spectrum haze = kHazeAlbedo * haze_;
  const float haze_share = haze_phase(cosine);
  const double up = std::max(0.0, static_cast<double>(direction.y()));
  Spectrum sum = Spectrum::Zero();
  AirAmounts seen, lit;
  march_cubic(distance_to_top(kEarthRadius, up), kViewSteps, [&](double along, double length) {
    const double radius = radius_along(kEarthRadius, up, along);
    const AirAmounts here = densities_at(radius - kEarthRadius);
    const auto step = static_cast<float>(length);
    const AirAmounts middle = seen.plus(here, 0.5f * step);
    seen = seen.plus(here, step);
    // The place's vector from the earth's centre is (0, R, 0) + along * direction.
    const double cos_sun =
        (kEarthRadius * static_cast<double>(to_sun.y()) + along * static_cast<double>(cosine)) / radius;
    Spectrum light = (here.air * air_ + here.haze * haze) * repeated(radius, cos_sun);
    if (columns_.to_space(radius, cos_sun, lit))
      light += (here.air * by_air + here.haze * haze_share * haze) * transmittance(lit);
    sum += light * transmittance(middle) * step;
  });
  return sum * solar_irradiance();
}

Spectrum Atmosphere::sun_irradiance(const Vec3& to_sun) const {
  AirAmounts column;
  if (to_sun.y() < 0.0f || !columns_.to_space(kEarthRadius, static_cast<double>(to_sun.y()), column))
    return Spectrum::Zero();
  return solar_irradiance() * transmittance(column);
}

}  // namespace gatelight::renderer
