#pragma once
// Named blocks of a sweep: those of a sweep without flags, the finished pictures of the presets of `render`,
// and the experiments of the GATE paper (Boksansky, Meister, Benthin, HPG 2025).

#include <string>
#include <string_view>
#include <vector>

#include "apps/sweep/plan.h"

namespace gatelight::apps {

/// Default training steps of integrators with a cache.
inline const std::vector<int> kDefaultSteps = {8, 16, 32, 64, 128, 256, 512, 1024};

/// The rows of a sweep without flags: the bare cache with rising steps, and the finished picture with rising
/// steps and samples. Rows are named after their presets of `render`.
std::vector<SweepBlock> default_rows();

/// finished, paper-table1, paper-table2 ..., then those of `render`.
std::vector<std::string_view> sweep_preset_names();

struct SweepPreset {
  std::vector<SweepBlock> blocks;
  int seeds = 3;
  std::vector<int> plain_spp;  ///< samples of integrators without a cache; empty: they are not measured
};

/// The preset of this name. It has no blocks for other names.
SweepPreset sweep_preset(std::string_view name);

}  // namespace gatelight::apps
