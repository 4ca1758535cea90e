#pragma once

#include <span>

namespace gatelight::renderer {

/// Of the errors of all pixels. The quartiles are weighted: the errors up to `first_quartile`, say, make a
/// quarter of the sum of all errors. Zero where there is no error.
struct FlipSummary {
  double mean = 0.0;
  double weighted_median = 0.0;
  double first_quartile = 0.0;
  double third_quartile = 0.0;
  double min = 0.0;
  double max = 0.0;
};

namespace flip {

/// Not empty, all in [0, 1].
FlipSummary summarize(std::span<const float> errors);

}  // namespace flip
}  // namespace gatelight::renderer
