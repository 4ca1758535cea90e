#pragma once
// The filters of FLIP. Each is a product of one along x and one along y. The pixels per degree decide their
// size.

#include <vector>

namespace gatelight::renderer::flip {

/// The weights of the pixels -radius() to radius().
struct Kernel {
  std::vector<float> weights;

  int radius() const { return static_cast<int>(weights.size() / 2); }
};

struct Filters {
  // The contrast sensitivity of the eye (2020, section 4.1.1). Blue-yellow is the sum of two products; its
  // weights sum to 1.
  Kernel achromatic, red_green, blue_yellow_wide, blue_yellow_narrow;
  // A Gaussian and its derivatives (2020, section 4.2). Positive weights sum to 1, negative ones to -1.
  Kernel gaussian, edge, point;

  int radius() const;  ///< of the largest filter
};

Filters make_filters(double pixels_per_degree);

}  // namespace gatelight::renderer::flip
