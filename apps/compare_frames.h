#pragma once
// `compare --frames`: two sequences of pictures.

#include <vector>

#include "apps/reports/compare_report.h"
#include "apps/settings/compare_settings.h"

namespace gatelight::apps {

/// Throws BadOption where --frames, or its absence, does not go with the names and the other flags.
void check_frames(const CompareSettings& settings, const std::vector<Metric>& metrics);

/// With --frames: compares frame after frame and writes the results. Two pictures at a time are in memory.
void compare_frames(const CompareSettings& settings, const std::vector<Metric>& metrics);

}  // namespace gatelight::apps
