#include "renderer/metrics/flip/color_spaces.h"

#include <Eigen/LU>

namespace gatelight::renderer::flip {
namespace {

/// The matrix from linear RGB to XYZ relative to white: that of the sRGB primaries, each row divided by its
/// sum.
Eigen::Matrix3d make_rgb_to_xyz() {
  Eigen::Matrix3d m;
  m << 10135552.0, 8788810.0, 4435075.0,  //
      2613072.0, 8788810.0, 887015.0,     //
      1425312.0, 8788810.0, 70074185.0;
  for (Eigen::Index row = 0; row < 3; ++row) m.row(row) /= m.row(row).sum();
  return m;
}

const Eigen::Matrix3f kRgbToXyz = make_rgb_to_xyz().cast<float>();
const Eigen::Matrix3f kXyzToRgb = make_rgb_to_xyz().inverse().cast<float>();

Row dot(const Eigen::Matrix3f& m, Eigen::Index row, const Row& a, const Row& b, const Row& c) {
  return m(row, 0) * a + m(row, 1) * b + m(row, 2) * c;
}

/// CIE's lightness curve: a cube root with a linear part near 0.
Row lightness_curve(const Row& t) {
  constexpr float kDelta = 6.0f / 29.0f;
  return (t > kDelta * kDelta * kDelta)
      .select(t.max(0.0f).pow(1.0f / 3.0f), t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f);
}

}  // namespace

OpponentRow rgb_to_ycxcz(const RgbRow& rgb) {
  const Row x = dot(kRgbToXyz, 0, rgb.r, rgb.g, rgb.b);
  const Row y = dot(kRgbToXyz, 1, rgb.r, rgb.g, rgb.b);
  const Row z = dot(kRgbToXyz, 2, rgb.r, rgb.g, rgb.b);
  return {116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z)};
}

RgbRow ycxcz_to_unit_rgb(const OpponentRow& ycxcz) {
  const Row y = (ycxcz.y + 16.0f) / 116.0f;
  const Row x = y + ycxcz.red_green / 500.0f;
  const Row z = y - ycxcz.blue_yellow / 200.0f;
  const auto unit = [&](Eigen::Index channel) -> Row {
    return dot(kXyzToRgb, channel, x, y, z).max(0.0f).min(1.0f);
  };
  return {unit(0), unit(1), unit(2)};
}

OpponentRow rgb_to_hunt_lab(const RgbRow& rgb) {
  const Row x = lightness_curve(dot(kRgbToXyz, 0, rgb.r, rgb.g, rgb.b));
  const Row y = lightness_curve(dot(kRgbToXyz, 1, rgb.r, rgb.g, rgb.b));
  const Row z = lightness_curve(dot(kRgbToXyz, 2, rgb.r, rgb.g, rgb.b));
  const Row lightness = 116.0f * y - 16.0f;
  return {lightness, 0.01f * lightness * (500.0f * (x - y)), 0.01f * lightness * (200.0f * (y - z))};
}

Row hyab_distance(const OpponentRow& a, const OpponentRow& b) {
  return (a.y - b.y).abs() +
         ((a.red_green - b.red_green).square() + (a.blue_yellow - b.blue_yellow).square()).sqrt();
}

}  // namespace gatelight::renderer::flip
