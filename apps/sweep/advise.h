#pragma once
// Chooses the fastest configuration that is accurate enough, or the most accurate that is fast enough.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/flag_values.h"

namespace gatelight::apps {

struct AdviceLimits {
  std::optional<double> max_error;    ///< mean FLIP of a picture, with every seed
  std::optional<double> max_seconds;  ///< of scouting, training and rendering
};

/// The cells of a series with the same number of steps (or samples): means over the seeds.
struct Configuration {
  std::string scene;
  std::string reference;     ///< kind of the reference
  std::string reference_id;  ///< only errors against the same reference are compared
  std::string series;
  FlagValues axes;
  std::string point;  ///< "128 steps, 4 spp"
  std::string command;
  int seeds = 0;
  double error = 0.0;  ///< FLIP
  double smallest_error = 0.0;
  double largest_error = 0.0;
  double seconds = 0.0;
};

/// The configurations in results.json, in its order. Cells that failed or have no FLIP are left out.
std::vector<Configuration> configurations(const nlohmann::ordered_json& results);

struct Advice {
  Configuration best;
  bool met = false;  ///< whether it is within the limits; otherwise it is the nearest
};

/// Chooses among configurations with one reference, at least one: the fastest within max_error (with every
/// seed), or with only max_seconds the one with the smallest error. Where none meets the limits: the
/// smallest error among those that are fast enough, or else the fastest.
Advice choose(const std::vector<Configuration>& candidates, const AdviceLimits& limits);

struct AdviceReport {
  std::string text;   ///< the advice for each reference, with its command; a line break at its end
  std::string unmet;  ///< why some reference has no advice, in a line; else empty
};

/// Throws nlohmann::json::exception where `results` is no result of a sweep.
AdviceReport give_advice(const nlohmann::ordered_json& results, const AdviceLimits& limits);

}  // namespace gatelight::apps
