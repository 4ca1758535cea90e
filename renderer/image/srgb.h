#pragma once
// The sRGB transfer function (IEC 61966-2-1) and its inverse.

#include <array>
#include <cmath>

namespace gatelight::renderer {

inline float srgb_to_linear(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

inline float linear_to_srgb(float x) {
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

/// The linear value of each of the 256 bytes.
inline const std::array<float, 256> kSrgbToLinear = [] {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = srgb_to_linear(static_cast<float>(i) / 255.0f);
  return table;
}();

}  // namespace gatelight::renderer
