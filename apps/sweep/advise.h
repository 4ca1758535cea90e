#pragma once
// The cheapest configuration that was good enough, or the best that was cheap enough.

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

/// The cells of a series with the same number of steps (samples): means over the seeds.
struct Configuration {
  std::string scene;
  std::string reference;     ///< its kind
  std::string reference_id;  ///< errors against different references are not compared
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

/// From results.json, in its order. Cells that failed or have no FLIP are left out.
std::vector<Configuration> configurations(const nlohmann::ordered_json& results);

struct Advice {
  Configuration best;
  bool met = false;  ///< whether it is within the limits; else it is the one that comes nearest
};

/// Of configurations with one reference, at least one. Within max_error (with every seed) the fastest; within
/// max_seconds alone that with the smallest error. Where none meets the limits: of those that are fast enough
/// the one with the smallest error, or where none is, the fastest.
Advice choose(const std::vector<Configuration>& candidates, const AdviceLimits& limits);

/// For each reference the advice with its command. Throws nlohmann::json::exception where `results` are none.
std::string advice_text(const nlohmann::ordered_json& results, const AdviceLimits& limits);

}  // namespace gatelight::apps
