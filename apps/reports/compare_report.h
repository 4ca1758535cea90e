#pragma once
// The measures of `compare` and of sweeps, as text and as JSON.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/parsing.h"
#include "renderer/metrics/compare.h"
#include "renderer/metrics/flip.h"
#include "renderer/metrics/temporal.h"

namespace gatelight::apps {

enum class Metric : std::uint8_t { mse, rel_mse, psnr, mean, max, ssim, flip, hdr_flip, temporal };

inline constexpr renderer::Choice<Metric> kMetrics[] = {
    {"mse", Metric::mse},   {"rel_mse", Metric::rel_mse},   {"psnr", Metric::psnr},
    {"mean", Metric::mean}, {"max", Metric::max},           {"ssim", Metric::ssim},
    {"flip", Metric::flip}, {"hdr_flip", Metric::hdr_flip}, {"temporal", Metric::temporal}};

struct CompareReport {
  std::vector<std::string> references;  ///< files: one, or two halves
  std::vector<std::string> tests;
  int width = 0;
  int height = 0;
  std::vector<Metric> metrics;  ///< requested, in the order of the report
  renderer::ErrorMetrics errors;
  renderer::FlipOptions flip_options;  ///< exposure and curve also of ssim
  std::optional<double> ssim;          ///< empty: not requested, or the picture is smaller than the window
  std::optional<renderer::FlipResult> flip;  ///< present where requested, as hdr_flip is
  std::optional<renderer::FlipResult> hdr_flip;
  std::optional<double> bias_rel_mse;   ///< of halves
  std::optional<double> rel_mse_clean;  ///< in a sweep: without the noise of the reference, if it is known
};

/// Measures for `compare`. Pixels that are not finite are left out with a warning. Where a metric of the
/// report needs all pixels, or another use does (`others_need_all`), they are refused with InputError.
void measure_pair(CompareReport& report, const renderer::NamedPicture& reference,
                  const renderer::NamedPicture& test, bool others_need_all, bool by_name);

/// Sets ssim, flip and hdr_flip where the report's metrics have them. `by_name`: the user named the metrics,
/// so SSIM of a picture smaller than its window is refused. HDR-FLIP is slow where the reference has many
/// stops: it calls go_on(fraction done), and where that returns false, so does the function.
bool measure_looks(
    CompareReport& report, const renderer::NamedPicture& reference, const renderer::NamedPicture& test,
    bool by_name, const std::function<bool(double)>& go_on = [](double) { return true; });

std::string compare_text(const CompareReport& report);
std::string compare_json(const CompareReport& report);

/// Of `compare --frames`.
struct CompareFramesReport {
  /// Names with the place of a frame's number, sums of pixels, and what the frames share.
  CompareReport whole;
  std::vector<int> numbers;           ///< of the frames, in the order of comparison; at least one
  std::vector<CompareReport> frames;  ///< without the errors of each pixel
  std::optional<renderer::TemporalDeviation> temporal;  ///< present where requested
};

std::string compare_frames_text(const CompareFramesReport& report);
std::string compare_frames_json(const CompareFramesReport& report);

}  // namespace gatelight::apps
