#pragma once
// The plan of a sweep: every combination of its axes, each picture once.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/sweep/flag_values.h"
#include "apps/sweep/planned.h"

namespace gatelight::apps {

/// Axes that are combined with each other. A sweep by flags has one block; presets have several.
struct SweepBlock {
  std::string row{};  ///< name of its row in a table; empty: none
  FlagValues base{};  ///< flags of all its cells, except --seed, --train-steps and the --spp of integrators
                      ///< without a cache
  std::vector<SweepAxis> axes{};  ///< --spp here is for integrators with a cache
  std::vector<int> train_steps{};
  std::optional<FlagValues> run{};  ///< a named run, `row` is its name: its own flags, over those of `base`
};

struct SweepScene {
  std::string name;  ///< short and unique
  std::string file;
  FlagValues flags;  ///< of this scene only, such as camera and environment
};

struct SweepRequest {
  std::vector<SweepScene> scenes;
  std::vector<SweepBlock> blocks;
  std::vector<int> plain_spp;
  bool allow_external = false;  ///< for all scenes
  bool plain = true;            ///< also measure the corresponding integrator without a cache
  std::uint32_t first_seed = 1;
  int seeds = 1;
};

/// Checks every cell. Throws BadOption, naming the bad value.
SweepPlan make_plan(const SweepRequest& request);

/// The plan as text, for --dry-run.
std::string plan_text(const SweepPlan& plan);

}  // namespace gatelight::apps
