#pragma once
// Which pictures a sweep makes: every combination of its axes, each picture once.

#include <cstdint>
#include <string>
#include <vector>

#include "apps/sweep/axes.h"
#include "apps/sweep/flag_values.h"
#include "apps/sweep/planned.h"

namespace gatelight::apps {

/// Axes that are combined with each other. A sweep of flags has one block; presets have several.
struct SweepBlock {
  std::string row;  ///< name of its line in a table; empty: none
  FlagValues
      base;  ///< holds for all its cells; without --seed, --train-steps and the --spp of plain integrators
  std::vector<SweepAxis> axes;  ///< --spp among them is for integrators with a cache
  std::vector<int> train_steps;
};

struct SweepScene {
  std::string name;  ///< short, different from the others'
  std::string file;
  FlagValues flags;  ///< of this scene alone: its camera, its sky
};

struct SweepRequest {
  std::vector<SweepScene> scenes;
  std::vector<SweepBlock> blocks;
  std::vector<int> plain_spp;
  bool allow_external = false;  ///< of all scenes
  bool plain = true;            ///< beside each integrator with a cache the one that it stands in for
  std::uint32_t first_seed = 1;
  int seeds = 1;
};

/// Checks every cell; throws UsageError naming the bad value.
SweepPlan make_plan(const SweepRequest& request);

/// The plan for people: --dry-run.
std::string plan_text(const SweepPlan& plan);

}  // namespace gatelight::apps
