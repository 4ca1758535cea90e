#pragma once
// How far the picture of a cell is from its reference.

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
  std::optional<renderer::FlipResult> flip;  ///< none: pixels are not finite
  std::optional<double> hdr_flip;
  std::optional<double> ssim;  ///< none: as for FLIP, or the picture is smaller than a window
};

/// noise: the rel_mse that the reference has of its own. FLIP and SSIM see the pictures with the exposure and
/// curve of `image`; HDR-FLIP is for radiance alone. It takes long where the reference has many stops:
/// `go_on` is told how much of it is done, and where it answers false, nothing is answered.
std::optional<CellErrors> measure_errors(const renderer::NamedPicture& reference, std::optional<double> noise,
                                         const renderer::NamedPicture& test,
                                         const renderer::ImageWriteOptions& image, bool with_hdr_flip,
                                         const std::function<bool(double)>& go_on);

}  // namespace gatelight::apps
