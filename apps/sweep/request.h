#pragma once
// The words of `gatelight sweep` into axes and what holds for all cells.

#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/plan.h"

namespace gatelight::apps {

/// A flag of `sweep` that takes the values of a flag of `render`.
struct AxisFlag {
  const char* name;    ///< "--encodings"
  const char* varies;  ///< "--encoding"
  bool values_are_lists = false;
};
inline constexpr AxisFlag kAxisFlags[] = {
    {"--integrators", "--integrator"}, {"--encodings", "--encoding"},
    {"--features", "--features"},      {"--resolution", "--resolution"},
    {"--stack", "--stack", true},      {"--cache-memory", "--cache-memory"},
    {"--hidden", "--hidden"},          {"--learning-rate", "--learning-rate"},
    {"--cache-spp", "--spp"},
};

/// Flags of `render` that hold for all cells of a sweep where they are given, or can be varied: those that
/// decide the picture, with a value. `sweep` has others of the name of some.
const std::vector<std::string>& base_flag_names();

struct SweepWords {
  std::vector<std::string> scenes;
  std::string preset;  ///< of `sweep` or of `render`
  FlagValues base;
  std::vector<std::pair<AxisFlag, std::string>> axes;
  std::vector<std::string> vary;
  std::vector<std::string> scene_flags;  ///< "sponza:camera=hall"
  std::optional<std::string> train_steps;
  std::optional<std::string> spp;
  std::optional<std::string> seeds;
  bool no_plain = false;
  bool allow_external = false;
};

/// Throws UsageError. Values of axes are checked by make_plan().
SweepRequest make_request(const SweepWords& words);

}  // namespace gatelight::apps
