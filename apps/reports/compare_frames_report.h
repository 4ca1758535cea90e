#pragma once
// The results of `compare --frames` as text and as JSON.

#include <optional>
#include <string>
#include <vector>

#include "apps/reports/compare_report.h"
#include "renderer/metrics/temporal.h"

namespace gatelight::apps {

/// The results of one frame. NaN: not requested, or the picture is smaller than the window of SSIM.
struct ComparedFrame {
  int number = 0;
  renderer::ErrorMetrics errors;
  double ssim = 0.0;
  double flip = 0.0;  ///< mean over the pixels, as hdr_flip is
  double hdr_flip = 0.0;
};

struct CompareFramesReport {
  std::string reference;  ///< the names with the place of a frame's number
  std::string test;
  int width = 0;
  int height = 0;
  std::vector<Metric> metrics;  ///< requested, in the order of the report
  renderer::FlipOptions flip_options;
  std::vector<ComparedFrame> frames;                    ///< at least one, in the order of comparison
  std::optional<renderer::TemporalDeviation> temporal;  ///< present where requested
};

std::string compare_frames_text(const CompareFramesReport& report);
std::string compare_frames_json(const CompareFramesReport& report);

}  // namespace gatelight::apps
