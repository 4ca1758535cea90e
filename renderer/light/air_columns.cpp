#include "renderer/light/air_columns.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace gatelight::renderer {
namespace {

constexpr int kTableHeights = 128, kTableCosines = 96;
constexpr int kTableSteps = 96;

/// Heights are denser near the ground, cosines near the horizon.
double square_of(int i, int count) {
  const double t = static_cast<double>(i) / (count - 1);
  return t * t;
}

AirAmounts integrate(double radius, double cosine) {
  double air = 0.0, haze = 0.0, ozone = 0.0;
  march_cubic(distance_to_top(radius, cosine), kTableSteps, [&](double distance, double length) {
    const AirAmounts here = densities_at(radius_along(radius, cosine, distance) - kEarthRadius);
    air += static_cast<double>(here.air) * length;
    haze += static_cast<double>(here.haze) * length;
    ozone += static_cast<double>(here.ozone) * length;
  });
  return {static_cast<float>(air), static_cast<float>(haze), static_cast<float>(ozone)};
}

}  // namespace

AirAmounts densities_at(double height) {
  const double h = std::max(0.0, height);
  return {static_cast<float>(std::exp(-h / kAirScale)), static_cast<float>(std::exp(-h / kHazeScale)),
          static_cast<float>(std::max(0.0, 1.0 - std::abs(h - kOzonePeak) / kOzoneReach))};
}

double distance_to_top(double radius, double cosine) {
  const double top = kEarthRadius + kAtmosphereHeight;
  return -radius * cosine + std::sqrt(std::max(0.0, top * top - radius * radius * (1.0 - cosine * cosine)));
}

double distance_to_ground(double radius, double cosine) {
  const double inside = kEarthRadius * kEarthRadius - radius * radius * (1.0 - cosine * cosine);
  return cosine < 0.0 && inside > 0.0 ? std::max(0.0, -radius * cosine - std::sqrt(inside)) : -1.0;
}

AirColumns::AirColumns() : table_(std::size_t{kTableHeights} * kTableCosines) {
  tbb::parallel_for(0, kTableHeights, [&](int i) {
    const double radius = kEarthRadius + kAtmosphereHeight * square_of(i, kTableHeights);
    for (int j = 0; j < kTableCosines; ++j)
      table_[static_cast<std::size_t>(i * kTableCosines + j)] =
          integrate(radius, square_of(j, kTableCosines));
  });
}

AirAmounts AirColumns::upwards(double radius, double cosine) const {
  const double x =
      std::sqrt(std::clamp((radius - kEarthRadius) / kAtmosphereHeight, 0.0, 1.0)) * (kTableHeights - 1);
  const double y = std::sqrt(std::clamp(cosine, 0.0, 1.0)) * (kTableCosines - 1);
  const int i = std::min(static_cast<int>(x), kTableHeights - 2);
  const int j = std::min(static_cast<int>(y), kTableCosines - 2);
  const auto s = static_cast<float>(x - i), t = static_cast<float>(y - j);
  const AirAmounts* at = table_.data() + static_cast<std::ptrdiff_t>(i) * kTableCosines + j;
  AirAmounts sum;
  return sum.plus(at[0], (1.0f - s) * (1.0f - t))
      .plus(at[1], (1.0f - s) * t)
      .plus(at[kTableCosines], s * (1.0f - t))
      .plus(at[kTableCosines + 1], s * t);
}

bool AirColumns::to_space(double radius, double cosine, AirAmounts& amounts) const {
  if (cosine >= 0.0) {
    amounts = upwards(radius, cosine);
    return true;
  }
  // Down to the lowest point of the ray and up again: twice the half, minus the part behind its origin.
  const double lowest = radius * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  if (lowest < kEarthRadius) return false;
  const AirAmounts half = upwards(lowest, 0.0);
  const AirAmounts both = half.plus(half).plus(upwards(radius, -cosine), -1.0f);
  amounts = {std::max(both.air, half.air), std::max(both.haze, half.haze), std::max(both.ozone, half.ozone)};
  return true;
}

}  // namespace gatelight::renderer
