#include "apps/measure_pair.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"

namespace gatelight::apps {
namespace {

using renderer::NamedPicture;

/// Whether the metric is a mean over pixels, so that some pixels can be left out.
bool leaves_pixels_out(Metric metric) {
  return metric != Metric::ssim && metric != Metric::flip && metric != Metric::hdr_flip &&
         metric != Metric::temporal;
}

}  // namespace

void measure_errors(CompareReport& report, const NamedPicture& reference, const NamedPicture& test,
                    bool others_need_all) {
  report.errors = renderer::compare_pictures(reference, test);
  const renderer::ErrorMetrics& errors = report.errors;
  if (errors.nonfinite_reference + errors.nonfinite_test == 0) return;
  const std::string counts =
      fmt::format("pixels that are not finite: {} in '{}', {} in '{}'", errors.nonfinite_reference,
                  reference.name, errors.nonfinite_test, test.name);
  if (others_need_all || !std::all_of(report.metrics.begin(), report.metrics.end(), leaves_pixels_out)) {
    throw InputError(
        fmt::format("{}; expected none for ssim, flip, hdr_flip and temporal (--metric "
                    "mse,rel_mse,psnr,mean,max ignores them)",
                    counts));
  }
  if (errors.pixels == 0) throw InputError(fmt::format("{}; nothing is left to compare", counts));
  log_warning(fmt::format("{}; they are ignored", counts));
}

}  // namespace gatelight::apps
