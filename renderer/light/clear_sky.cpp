#include "renderer/light/clear_sky.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "renderer/light/atmosphere.h"
#include "renderer/light/solar_position.h"

namespace gatelight::renderer {
namespace {

constexpr int kSkyWidth = 512, kSkyHeight = 256;
constexpr float kMaxLight = 1e30f;  ///< bound of radiance and irradiance, so that sums stay finite

/// Clamps at zero, because Rec. 709 cannot represent all colours of the sky.
Color displayable(const Spectrum& spectrum, float scale) {
  const Color color = daylight_color(spectrum);
  return (color.max(0.0f) * scale).min(kMaxLight);
}

double row_elevation(double row) {
  return M_PI * (0.5 - row / kSkyHeight);
}

Vec3 direction_of(int x, int y) {
  const double elevation = row_elevation(y + 0.5);
  const double phi = 2.0 * M_PI * ((x + 0.5) / kSkyWidth - 0.5);
  return {static_cast<float>(std::cos(elevation) * std::sin(phi)), static_cast<float>(std::sin(elevation)),
          static_cast<float>(-std::cos(elevation) * std::cos(phi))};
}

/// The irradiance of the rows above the horizon on a level plane.
Color level_irradiance(const std::vector<Color>& texels) {
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (int y = 0; y < kSkyHeight / 2; ++y) {
    Eigen::Array3d row = Eigen::Array3d::Zero();
    for (int x = 0; x < kSkyWidth; ++x)
      row += texels[static_cast<std::size_t>(y * kSkyWidth + x)].cast<double>();
    const double top = std::sin(row_elevation(y)), bottom = std::sin(row_elevation(y + 1));
    // The integral of sine times solid angle over the row of one texel.
    sum += row * (M_PI / kSkyWidth * (top * top - bottom * bottom));
  }
  return sum.cast<float>();
}

}  // namespace

ClearSky make_clear_sky(const SkyOptions& options, float scale) {
  SolarPosition sun{static_cast<double>(options.sun_azimuth_degrees),
                    static_cast<double>(options.sun_elevation_degrees)};
  if (options.time) sun = solar_position(*options.time);
  const double elevation = sun.elevation_degrees * M_PI / 180.0;
  const Vec3 to_sun(0.0f, static_cast<float>(std::sin(elevation)), static_cast<float>(-std::cos(elevation)));
  const float radius = 0.5f * options.sun_size_degrees * kPi / 180.0f;
  const float factor = scale * options.intensity;

  const Atmosphere atmosphere(options.turbidity, options.ground);
  std::vector<Color> texels(std::size_t{kSkyWidth} * kSkyHeight);
  tbb::parallel_for(0, kSkyHeight / 2, [&](int y) {
    Color* row = texels.data() + static_cast<std::ptrdiff_t>(y) * kSkyWidth;
    for (int x = 0; x < kSkyWidth / 2; ++x) {
      row[x] = displayable(atmosphere.sky_radiance(direction_of(x, y), to_sun), factor);
      row[kSkyWidth - 1 - x] = row[x];
    }
  });

  // A part of a rising disc is below the horizon; the light of the rest comes from the horizon.
  const Vec3 lit = to_sun.y() >= 0.0f ? to_sun : Vec3(0.0f, 0.0f, -1.0f);
  Color irradiance = Color::Zero();
  if (elevation > -static_cast<double>(radius))
    irradiance = displayable(atmosphere.sun_irradiance(lit), factor);

  const Color received = level_irradiance(texels) + irradiance * std::max(0.0f, to_sun.y());
  const Color ground = (received * (options.ground * kInvPi)).min(kMaxLight);
  std::fill(texels.begin() + static_cast<std::ptrdiff_t>(kSkyHeight / 2) * kSkyWidth, texels.end(), ground);
  return {EnvironmentPicture(kSkyWidth, kSkyHeight, std::move(texels)),
          to_sun,
          radius,
          irradiance,
          sun.azimuth_degrees,
          sun.elevation_degrees};
}

}  // namespace gatelight::renderer
