#pragma once
// FLIP: how different two pictures look when they alternate at the same place. LDR: Andersson, Nilsson,
// Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG
// 2020.
// HDR: Andersson, Nilsson, Shirley, Akenine-Moller, "Visualizing Errors in Rendered High Dynamic Range
// Images", Eurographics 2021.

#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

struct FlipOptions {
  /// Pixels per degree of visual angle, from kMinPixelsPerDegree to kMaxPixelsPerDegree. The published
  /// default is a monitor 0.7 m wide with 3840 pixels, seen from 0.7 m.
  double pixels_per_degree = 3840.0 * std::numbers::pi / 180.0;
  // How ldr_flip() converts radiance for the screen.
  float exposure = 0.0f;  ///< stops
  Tonemap tonemap = Tonemap::none;
};

inline constexpr double kMinPixelsPerDegree = 1.0;
inline constexpr double kMaxPixelsPerDegree = 1000.0;

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

struct FlipResult {
  int width = 0;
  int height = 0;
  std::vector<float> errors;  ///< in [0, 1]; the first row is the top
  FlipSummary summary;
  // Only hdr_flip() sets these.
  double start_exposure = 0.0;  ///< stops
  double stop_exposure = 0.0;
  int exposures = 0;
};

/// Compares pictures as a screen shows them: radiance times 2^exposure, through the tone curve, clamped to
/// [0, 1], not rounded to bytes. Symmetric; equal pictures give exactly 0. Gives the same bits for any number
/// of threads. Throws what require_comparable() throws, InputError for pictures without pixels or with
/// values that are not finite, and BadOption for pixels_per_degree.
FlipResult ldr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options = {});

/// The largest LDR error of each pixel over a range of exposures, shown through the ACES curve. The first
/// exposure shows the reference's brightest pixel just below white, the last one its median. The exposures
/// are evenly spaced; their number is the range in stops, rounded up, at least 2. Where at least half of the
/// reference is black, the median is that of the other pixels. A black reference is compared at exposure 0.
/// Does not use options.exposure and options.tonemap. Throws what ldr_flip() throws.
FlipResult hdr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options = {});
/// The same with progress, for pictures with many stops. Calls `go_on` before each exposure with the fraction
/// that is done. Returns nothing when go_on returns false.
std::optional<FlipResult> hdr_flip(const NamedPicture& reference, const NamedPicture& test,
                                   const FlipOptions& options, const std::function<bool(double)>& go_on);

/// `errors` is not empty; all values are in [0, 1].
FlipSummary summarize(std::span<const float> errors);

/// The errors in the published colours (magma), from black (0) over violet, red and orange to pale yellow
/// (1). A PNG shows these colours when it is written without exposure and curve.
Picture flip_map(const FlipResult& result);

}  // namespace gatelight::renderer
