#pragma once
// Moments of a picture whose pixels are independent estimates of the same number.

#include <cstddef>
#include <vector>

#include "renderer/image/picture.h"
#include "tests/support/statistics.h"

namespace gatelight::testing {

/// One channel of the beauty layer.
inline Moments channel_moments(const renderer::Picture& picture, std::size_t channel) {
  Moments moments;
  const std::vector<float>& values = picture.layers[0].values;
  for (std::size_t i = channel; i < values.size(); i += 3) moments.add(static_cast<double>(values[i]));
  return moments;
}

/// All channels of the beauty layer.
inline Moments moments_of(const renderer::Picture& picture) {
  Moments moments;
  for (const float value : picture.layers[0].values) moments.add(static_cast<double>(value));
  return moments;
}

}  // namespace gatelight::testing
