#include "renderer/image/tonemap.h"

#include <algorithm>
#include <cmath>

#include "renderer/image/srgb.h"

namespace gatelight::renderer {
namespace {

/// Clamps to [0, 1] and turns NaN into 0, which std::clamp does not.
float unit(float x) {
  if (!(x > 0.0f)) return 0.0f;
  return std::min(x, 1.0f);
}

}  // namespace

float filmic(float x) {
  // Beyond this value the curve is 1. Squares of huge values would give inf / inf.
  constexpr float kSaturated = 1e6f;
  if (x > kSaturated) return 1.0f;
  const float v = x > 0.0f ? x : 0.0f;
  return unit(v * (2.51f * v + 0.03f) / (v * (2.43f * v + 0.59f) + 0.14f));
}

std::uint8_t display_byte(float x, float scale, Tonemap tonemap) {
  const float exposed = x * scale;
  const float shown = tonemap == Tonemap::filmic ? filmic(exposed) : exposed;
  return static_cast<std::uint8_t>(std::lround(255.0f * linear_to_srgb(unit(shown))));
}

float exposure_scale(float stops) {
  return std::exp2(stops);
}

}  // namespace gatelight::renderer
