#pragma once
// FLIP: how different two pictures look when they are shown in turns at the same place.
// LDR: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for
// Alternating Images", HPG 2020. HDR: Andersson, Nilsson, Shirley, Akenine-Moller, "Visualizing Errors in
// Rendered High Dynamic Range Images", Eurographics 2021.

#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"
#include "renderer/metrics/flip/summary.h"

namespace gatelight::renderer {

struct FlipOptions {
  /// Of visual angle, from kMinPixelsPerDegree to kMaxPixelsPerDegree. The published default: a monitor 0.7 m
  /// wide with 3840 pixels, seen from 0.7 m.
  double pixels_per_degree = 3840.0 * std::numbers::pi / 180.0;
  // How ldr_flip() brings radiance onto the screen.
  float exposure = 0.0f;  ///< stops
  Tonemap tonemap = Tonemap::none;
};

inline constexpr double kMinPixelsPerDegree = 1.0;
inline constexpr double kMaxPixelsPerDegree = 1000.0;

struct FlipResult {
  int width = 0;
  int height = 0;
  std::vector<float> errors;  ///< in [0, 1], rows from the top
  FlipSummary summary;
  // Of hdr_flip().
  double start_exposure = 0.0;  ///< stops
  double stop_exposure = 0.0;
  int exposures = 0;
};

/// The pictures as a screen shows them: radiance (a PNG's bytes through the sRGB curve) times 2^exposure,
/// through the curve, cut to [0, 1]; not rounded to bytes. Symmetric; equal pictures give exactly 0. The same
/// bits for any number of threads. Throws CompareError for pictures of different sizes, without a beauty
/// layer, without pixels or with values that are not finite, BadOption for pixels_per_degree.
FlipResult ldr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options = {});

/// The largest LDR error over the exposures at which the reference's brightest pixel and its median are
/// shown just below white, and those in between, at most a stop apart, through the ACES curve. Throws like
/// ldr_flip(); options.exposure and tonemap are not used. Where at least half of the reference is black, the
/// median is that of the rest; a black reference is compared at exposure 0.
FlipResult hdr_flip(const NamedPicture& reference, const NamedPicture& test, const FlipOptions& options = {});
/// For the length of a picture with many stops: `go_on` is told the fraction that is done before each
/// exposure, and where it answers false there is no result.
std::optional<FlipResult> hdr_flip(const NamedPicture& reference, const NamedPicture& test,
                                   const FlipOptions& options, const std::function<bool(double)>& go_on);

/// The errors in the published colours (magma): black 0, violet, red, orange, pale yellow 1. Shows them when
/// it is written as a PNG without exposure and curve.
Picture flip_map(const FlipResult& result);

}  // namespace gatelight::renderer
