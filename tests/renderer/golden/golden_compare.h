#pragma once
// A test whether two pictures with variance layers can be estimates of the same one. tests/README.md explains
// it.

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::testing {

struct Rendered {
  const renderer::Picture& picture;  ///< with a layer "variance": of each pixel's mean
  int spp = 0;                       ///< independent samples
};

struct GoldenVerdict {
  bool agrees = true;
  std::string report;                 ///< the rejections, or the smallest p-values
  std::vector<float> pixel_p_values;  ///< interleaved as the picture
};

/// Two-sided tests of pixels, of blocks of 4x4 pixels and of the whole picture, and one-sided tests that the
/// scores of each do not spread more than they should; all together reject equal pictures with a
/// probability of at most `significance`. The reference must have at least as many samples as the test.
GoldenVerdict compare_with_reference(const Rendered& test, const Rendered& reference, double significance);

/// The p-values as a picture, to look at.
renderer::Picture p_value_picture(const GoldenVerdict& verdict, int width, int height);

}  // namespace gatelight::testing
