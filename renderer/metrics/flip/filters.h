#pragma once
// The filters of FLIP, each a product of one along x and one along y, as long as the pixels per degree ask.

#include <vector>

namespace gatelight::renderer::flip {

/// Weights of the pixels -radius() to radius().
struct Kernel {
  std::vector<float> weights;

  int radius() const { return static_cast<int>(weights.size() / 2); }
};

struct Filters {
  // What the eye still resolves (contrast sensitivity; 2020, section 4.1.1). Blue-yellow is the sum of two
  // products, which together sum up to 1.
  Kernel achromatic, red_green, blue_yellow_wide, blue_yellow_narrow;
  // Gaussian and its derivatives (2020, section 4.2): positive weights sum up to 1, negative ones to -1.
  Kernel gaussian, edge, point;

  int radius() const;  ///< the largest
};

Filters make_filters(double pixels_per_degree);

}  // namespace gatelight::renderer::flip
