#pragma once
// The cheapest configuration that was good enough, or the best that was cheap enough.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/sweep/sweep_settings.h"

namespace gatelight::apps {

/// The cells of a series with the same number of steps (samples): means over the seeds.
struct Configuration {
  std::string scene;
  std::string reference;  ///< kind: errors of different kinds are not compared
  std::string series;
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

/// Of configurations of one scene and kind, at least one. Within max_error the fastest; within max_seconds
/// alone that with the smallest error. Where none meets the limits: of those that are fast enough, or of all
/// where none is, the one with the smallest error (the fastest where no error is asked for).
Advice choose(const std::vector<Configuration>& candidates, const AdviceLimits& limits);

/// For each scene and kind of picture the advice with its command.
std::string advice_text(const nlohmann::ordered_json& results, const AdviceLimits& limits);

}  // namespace gatelight::apps
