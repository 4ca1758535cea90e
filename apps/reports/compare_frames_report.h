#pragma once
// The results of `compare --frames` as text and as JSON.

#include <optional>
#include <string>
#include <vector>

#include "apps/reports/compare_report.h"
#include "renderer/metrics/temporal.h"

namespace gatelight::apps {

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
