#pragma once
// The report of the frames of an animation as text.

#include <string>

#include "apps/reports/run_report.h"

namespace gatelight::apps {

/// One line for a finished frame.
std::string frame_line(int frame, const RenderSettings& settings, const RunReport& report);

/// The lines after the last frame.
std::string frames_summary(std::size_t frames, double seconds, const RunReport& report);

}  // namespace gatelight::apps
