#pragma once
// Chooses the fastest configuration that is accurate enough, or the most accurate that is fast enough.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/measured_runs.h"

namespace gatelight::apps {

struct AdviceLimits {
  std::optional<double> max_error;    ///< mean FLIP of a picture, with every seed
  std::optional<double> max_seconds;  ///< of scouting, training and rendering
};

struct Advice {
  const MeasuredRun* best = nullptr;
  bool met = false;  ///< whether it is within the limits; otherwise it is the nearest
};

/// Chooses among runs with one reference, at least one, all with a FLIP: the fastest within max_error (with
/// every seed), or with only max_seconds the one with the smallest error. Where none meets the limits: the
/// smallest error among those that are fast enough, or else the fastest.
Advice choose(const std::vector<MeasuredRun>& candidates, const AdviceLimits& limits);

struct AdviceReport {
  std::string text;   ///< the advice for each reference, with its command; a line break at its end
  std::string unmet;  ///< why some reference has no advice, in a line; else empty
};

/// Throws nlohmann::json::exception where `results` is no result of a sweep.
AdviceReport give_advice(const nlohmann::ordered_json& results, const AdviceLimits& limits);

}  // namespace gatelight::apps
