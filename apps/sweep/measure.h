#pragma once
// How far the picture of a cell is from its reference.

#include <optional>
#include <string>

#include "apps/render_settings.h"
#include "renderer/compare.h"
#include "renderer/flip.h"

namespace gatelight::apps {

struct CellErrors {
  renderer::ErrorMetrics metrics;
  std::optional<double> rel_mse_clean;       ///< without the reference's noise, where that is known
  std::optional<renderer::FlipResult> flip;  ///< none: pixels are not finite
  std::optional<double> hdr_flip;
};

/// noise: the rel_mse that the reference has of its own. FLIP sees the pictures as the settings' exposure and
/// curve show them; HDR-FLIP is for radiance alone.
CellErrors measure_errors(const renderer::NamedPicture& reference, std::optional<double> noise,
                          const renderer::NamedPicture& test, const renderer::ImageWriteOptions& image,
                          bool with_hdr_flip);

}  // namespace gatelight::apps
