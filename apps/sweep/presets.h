#pragma once
// The experiments of the GATE paper (Boksansky, Meister, Benthin, HPG 2025) as blocks of a sweep.

#include <string>
#include <string_view>
#include <vector>

#include "apps/sweep/plan.h"

namespace gatelight::apps {

inline constexpr int kPresetSeeds = 3;

/// paper-table1, paper-table2 ..., then those of `render`.
std::vector<std::string_view> sweep_preset_names();

/// The blocks of a preset; empty for other names.
std::vector<SweepBlock> sweep_preset(std::string_view name);

}  // namespace gatelight::apps
