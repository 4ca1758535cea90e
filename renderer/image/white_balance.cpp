#include "renderer/image/white_balance.h"

#include <Eigen/LU>
#include <algorithm>

namespace gatelight::renderer {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Chromaticity of a phase of daylight.
Vector2d daylight(double t) {
  const double x = t <= 7000.0 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                               : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
  return {x, (-3.0 * x + 2.870) * x - 0.275};
}

/// Chromaticity of a black body below 4000 K.
Vector2d black_body(double t) {
  const double x = ((-0.2661239e9 / t - 0.2343589e6) / t + 0.8776956e3) / t + 0.179910;
  const double y = t <= 2222.0 ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                               : ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867;
  return {x, y};
}

Vector3d white_of(double t) {
  constexpr double kWarm = 4000.0, kCold = 5000.0;
  const double share = std::clamp((t - kWarm) / (kCold - kWarm), 0.0, 1.0);
  const Vector2d xy = share * daylight(std::max(t, kWarm)) + (1.0 - share) * black_body(std::min(t, kWarm));
  return {xy.x() / xy.y(), 1.0, (1.0 - xy.x() - xy.y()) / xy.y()};
}

}  // namespace

Eigen::Matrix3f white_balance(float kelvin) {
  if (kelvin == kDaylightKelvin) return Eigen::Matrix3f::Identity();
  Matrix3d to_cone, to_xyz;
  to_cone << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
  to_xyz << 0.4123908, 0.3575843, 0.1804808, 0.2126390, 0.7151687, 0.0721923, 0.0193308, 0.1191948, 0.9505322;
  const Vector3d from = to_cone * white_of(static_cast<double>(kelvin));
  const Vector3d to = to_cone * white_of(static_cast<double>(kDaylightKelvin));
  const Matrix3d adapted = to_cone.inverse() * to.cwiseQuotient(from).asDiagonal() * to_cone;
  return (to_xyz.inverse() * adapted * to_xyz).cast<float>();
}

}  // namespace gatelight::renderer
