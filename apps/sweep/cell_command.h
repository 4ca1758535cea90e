#pragma once
// One cell of a series, as settings and as a command line.

#include <string>

#include "apps/sweep/planned.h"

namespace gatelight::apps {

/// The series' settings with scene, seed and point.
RenderSettings cell_settings(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                             int point);
/// `gatelight render` for it, ready for a shell.
std::string cell_command(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                         int point);

}  // namespace gatelight::apps
