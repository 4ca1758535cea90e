#pragma once
// The amounts of air, haze and ozone along rays through a round earth's atmosphere. Lengths are in
// kilometres. A ray is given by the distance of its origin to the earth's centre and the cosine of its angle
// from the vertical there.

#include <cmath>
#include <cstddef>
#include <vector>

namespace gatelight::renderer {

inline constexpr double kEarthRadius = 6371.0;
inline constexpr double kAtmosphereHeight = 100.0;  ///< there is no air above it
inline constexpr double kAirScale = 8.0;            ///< height in which the density falls by e
inline constexpr double kHazeScale = 1.2;           ///< the same for haze
/// The density of ozone falls linearly from its peak to 0 within its reach, as in Bruneton 2017, "A
/// Qualitative and Quantitative Evaluation of 8 Clear Sky Models".
inline constexpr double kOzonePeak = 25.0, kOzoneReach = 15.0;

/// Densities, or their integrals along a ray in kilometres. The densities of air and haze are 1 at sea level,
/// that of ozone is 1 at its peak.
struct AirAmounts {
  float air = 0.0f;
  float haze = 0.0f;
  float ozone = 0.0f;

  AirAmounts plus(const AirAmounts& other, float factor = 1.0f) const {
    return {air + factor * other.air, haze + factor * other.haze, ozone + factor * other.ozone};
  }
};

AirAmounts densities_at(double height);

/// The distance to the earth's centre after a distance along a ray.
inline double radius_along(double radius, double cosine, double distance) {
  return std::sqrt(radius * radius + distance * (distance + 2.0 * radius * cosine));
}

/// The distance to the top of the atmosphere.
double distance_to_top(double radius, double cosine);
/// The distance to the ground, negative for a ray that misses it.
double distance_to_ground(double radius, double cosine);

/// Tabulated integrals to space.
class AirColumns {
 public:
  /// Parallel (oneTBB), with the same bits for any number of threads.
  AirColumns();

  /// Sets `amounts` to the integrals along a ray to space. Returns false for a ray that meets the earth.
  bool to_space(double radius, double cosine, AirAmounts& amounts) const;

 private:
  AirAmounts upwards(double radius, double cosine) const;

  std::vector<AirAmounts> table_;  ///< by height and cosine
};

/// Calls visit(middle, length) for steps whose ends are at the cubes of equal parts of the distance: short at
/// the beginning.
template <class Visit>
void march_cubic(double distance, int steps, const Visit& visit) {
  double begin = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double part = static_cast<double>(i + 1) / steps;
    const double end = distance * part * part * part;
    visit(0.5 * (begin + end), end - begin);
    begin = end;
  }
}

}  // namespace gatelight::renderer
