#pragma once
// The scenes of a sweep.

#include <string>
#include <vector>

#include "apps/sweep/flag_values.h"

namespace gatelight::apps {

struct SweepScene {
  std::string name;  ///< short, different from the others'
  std::string file;
  FlagValues flags;  ///< of this scene alone: its camera, its sky
};

/// By their files' names, with those of their folders where two files have the same. Throws UsageError for a
/// file that is named twice.
std::vector<SweepScene> name_scenes(const std::vector<std::string>& files);

}  // namespace gatelight::apps
