#include "renderer/image/tonemap.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

#include "renderer/image/srgb.h"

namespace gatelight::renderer {
namespace {

using Eigen::Matrix3f;

/// Clamps to [0, 1] and turns NaN into 0, which std::clamp does not.
float unit(float x) {
  if (!(x > 0.0f)) return 0.0f;
  return std::min(x, 1.0f);
}

Color unit(const Color& color) {
  return color.unaryExpr([](float x) { return unit(x); });
}

Matrix3f rows(const std::array<float, 9>& values) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(values.data());
}

Color times(const Matrix3f& matrix, const Color& color) {
  return (matrix * color.matrix()).array();
}

/// The specification's sample code (github.com/KhronosGroup/ToneMapping), rewritten.
Color neutral(Color color) {
  constexpr float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
  const float least = color.minCoeff();
  color -= least < 0.08f ? least - 6.25f * least * least : 0.04f;
  const float peak = color.maxCoeff();
  if (peak < kStart) return color;
  constexpr float kRange = 1.0f - kStart;
  const float shown = 1.0f - kRange * kRange / (peak + kRange - kStart);
  color *= shown / peak;
  const float grey = 1.0f - 1.0f / (kDesaturation * (peak - shown) + 1.0f);
  return color + grey * (shown - color);
}

/// The matrices join sRGB, the ACES white point and the fit's working space; the rational function is the
/// fit.
Color aces(const Color& color) {
  static const Matrix3f in =
      rows({0.59719f, 0.35458f, 0.04823f, 0.07600f, 0.90834f, 0.01566f, 0.02840f, 0.13383f, 0.83777f});
  static const Matrix3f out =
      rows({1.60475f, -0.53108f, -0.07367f, -0.10208f, 1.10813f, -0.00605f, -0.00327f, -0.07276f, 1.07602f});
  const Color v = times(in, color);
  return times(out, (v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f));
}

/// The fit's polynomial makes values of a screen with an exponent of 2.2.
Color agx(const Color& color) {
  static const Matrix3f in =
      rows({0.842479062253094f, 0.0784335999999992f, 0.0792237451477643f, 0.0423282422610123f,
            0.878468636469772f, 0.0791661274605434f, 0.0423756549057051f, 0.0784336f, 0.879142973793104f});
  static const Matrix3f out = rows({1.19687900512017f, -0.0980208811401368f, -0.0990297440797205f,
                                    -0.0528968517574562f, 1.15190312990417f, -0.0989611768448433f,
                                    -0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f});
  constexpr float kMin = -12.47393f, kMax = 4.026069f;  // stops
  const Color x =
      ((times(in, color).max(1e-10f).log() * (1.0f / std::log(2.0f))).max(kMin).min(kMax) - kMin) /
      (kMax - kMin);
  const Color x2 = x * x, x4 = x2 * x2;
  const Color curve = 15.5f * x4 * x2 - 40.14f * x4 * x + 31.96f * x4 - 6.868f * x2 * x + 0.4298f * x2 +
                      0.1191f * x - 0.00232f;
  return unit(times(out, curve)).pow(2.2f);
}

}  // namespace

float filmic(float x) {
  // Beyond this value the curve is 1. Squares of huge values would give inf / inf.
  constexpr float kSaturated = 1e6f;
  if (x > kSaturated) return 1.0f;
  const float v = x > 0.0f ? x : 0.0f;
  return unit(v * (2.51f * v + 0.03f) / (v * (2.43f * v + 0.59f) + 0.14f));
}

Color tonemapped(const Color& color, Tonemap tonemap) {
  if (tonemap == Tonemap::filmic) return color.unaryExpr([](float x) { return filmic(x); });
  if (tonemap == Tonemap::none) return unit(color);
  // Beyond this all curves are white, and squares stay finite.
  constexpr float kLargest = 1e6f;
  const Color v = color.unaryExpr([=](float x) { return x > 0.0f ? std::min(x, kLargest) : 0.0f; });
  switch (tonemap) {
    case Tonemap::neutral:
      return unit(neutral(v));
    case Tonemap::aces:
      return unit(aces(v));
    default:
      return unit(agx(v));
  }
}

Color display_color(const Color& color, Tonemap tonemap) {
  return tonemapped(color, tonemap).unaryExpr([](float x) { return linear_to_srgb(x); });
}

std::uint8_t display_byte(float x, float scale, Tonemap tonemap) {
  return static_cast<std::uint8_t>(
      std::lround(255.0f * display_color(Color::Constant(x * scale), tonemap)[0]));
}

float exposure_scale(float stops) {
  return std::exp2(stops);
}

}  // namespace gatelight::renderer
