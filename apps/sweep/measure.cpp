#include "apps/sweep/measure.h"

#include "renderer/metrics/ssim.h"

namespace gatelight::apps {

std::optional<CellErrors> measure_errors(const renderer::NamedPicture& reference, std::optional<double> noise,
                                         const renderer::NamedPicture& test,
                                         const renderer::ImageWriteOptions& image, bool with_hdr_flip,
                                         const std::function<bool(double)>& go_on) {
  CellErrors errors{.metrics = renderer::compare_pictures(reference, test)};
  if (noise) errors.rel_mse_clean = errors.metrics.rel_mse - *noise;
  if (errors.metrics.nonfinite_reference + errors.metrics.nonfinite_test > 0) return errors;
  const renderer::FlipOptions options{.exposure = image.display.exposure, .tonemap = image.display.tonemap};
  errors.flip = renderer::ldr_flip(reference, test, options);
  if (renderer::has_ssim(test.picture)) {
    errors.ssim = renderer::ssim(reference, test,
                                 {.exposure = image.display.exposure, .tonemap = image.display.tonemap});
  }
  if (with_hdr_flip) {
    const std::optional<renderer::FlipResult> result = renderer::hdr_flip(reference, test, options, go_on);
    if (!result) return std::nullopt;
    errors.hdr_flip = result->summary.mean;
  }
  return errors;
}

}  // namespace gatelight::apps
