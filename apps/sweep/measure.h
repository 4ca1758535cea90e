#pragma once
// Errors of the picture of a cell against its reference.

#include <functional>
#include <optional>
#include <string>

#include "apps/settings/render_settings.h"
#include "renderer/metrics/compare.h"
#include "renderer/metrics/flip.h"

namespace gatelight::apps {

struct CellErrors {
  renderer::ErrorMetrics metrics;
  std::optional<double> rel_mse_clean;       ///< without the reference's noise, where that is known
  std::optional<double> bias_rel_mse;        ///< of the pair that the picture completes
  std::optional<renderer::FlipResult> flip;  ///< empty: some pixels are not finite
  std::optional<double> hdr_flip;
  std::optional<double> ssim;  ///< empty: as for FLIP, or the picture is smaller than the window
};

/// noise: the rel_mse of the reference itself. FLIP and SSIM use the exposure and curve of `image`; HDR-FLIP
/// is for radiance only. HDR-FLIP is slow where the reference has many stops: it calls go_on(fraction done),
/// and where that returns false, the function returns nothing.
std::optional<CellErrors> measure_errors(const renderer::NamedPicture& reference, std::optional<double> noise,
                                         const renderer::NamedPicture& test,
                                         const renderer::ImageWriteOptions& image, bool with_hdr_flip,
                                         const std::function<bool(double)>& go_on);

}  // namespace gatelight::apps
