#pragma once

#include <span>

namespace gatelight::renderer {

/// Statistics of the errors of all pixels. The quartiles are weighted: for example, the errors up to
/// `first_quartile` make a quarter of the sum of all errors. All are zero where there is no error.
struct FlipSummary {
  double mean = 0.0;
  double weighted_median = 0.0;
  double first_quartile = 0.0;
  double third_quartile = 0.0;
  double min = 0.0;
  double max = 0.0;
};

namespace flip {

/// `errors` is not empty; all values are in [0, 1].
FlipSummary summarize(std::span<const float> errors);

}  // namespace flip
}  // namespace gatelight::renderer
