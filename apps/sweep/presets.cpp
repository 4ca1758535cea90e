#include "apps/sweep/presets.h"

#include <sstream>

#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

/// The step counts of the paper: 128 in its tables, from 8 on in its figure.
const std::vector<int> kTableSteps = {128};
const std::vector<int> kFigureSteps = {8, 16, 32, 64, 128};

const char* const kPaperPresets[] = {"paper-nao", "paper-nrc"};

// The paper measures the hash grid with tiny-cuda-nn, which updates every entry in every step.

/// GATE and the hash grid at comparable memory.
constexpr const char* kEqualMemory = R"(
gate:
hash grid: --encoding hashgrid --update dense --cache-memory same-as-gate
hash grid, sparse updates: --encoding hashgrid --update sparse --cache-memory same-as-gate
)";

/// Sizes of the hash grid: L is as large as GATE, M half of it, S less than 1 MB.
constexpr const char* kHashSizes = R"(
gate:
hash grid L: --encoding hashgrid --update dense --cache-memory same-as-gate
hash grid M: --encoding hashgrid --update dense --cache-memory same-as-gate/2
hash grid S: --encoding hashgrid --update dense --cache-memory 0.91
)";

/// By default GATE reads the normal with other resolutions than the paper's.
constexpr const char* kResolutions = R"(
fixed R = 4: --resolution fixed:4 --normal-input off
adaptive, paper's rule: --resolution paper
adaptive, uniform: --resolution uniform --normal-input off
)";

/// Occlusion does not depend on the albedo.
constexpr const char* kNetworkInputs = R"(
gate: --preset paper-nao --normal-input off
gate, normal: --preset paper-nao --normal-input on
gate: --preset paper-nrc --normal-input off --albedo-input off
gate, normal: --preset paper-nrc --normal-input on --albedo-input off
gate, albedo: --preset paper-nrc --normal-input off --albedo-input on
gate, normal and albedo: --preset paper-nrc --normal-input on --albedo-input on
)";

/// Choices that the paper leaves open or does not measure; each row changes one. It does not show the picture
/// itself.
constexpr const char* kExtra = R"(
as in the paper:
storage per triangle: --storage per-triangle
counters per node: --feature-step per-node
no candidates: --candidates 1
4 samples per point: --samples-per-point 4
fp16 features: --feature-precision fp16
stack of 1: --stack adaptive
stack of 3: --stack adaptive,adaptive/3,1
clusters: --resolution uniform --normal-input off --cluster auto
uniform, no clusters: --resolution uniform --normal-input off
picture, primary: --preset paper-nrc --view final --spp 4 --query-at primary
picture, gather: --preset paper-nrc --view final --spp 4 --query-at gather
picture, holds no-delta: --preset paper-nrc --view final --spp 4 --query-at primary --cache-holds no-delta
picture, holds indirect: --preset paper-nrc --view final --spp 4 --query-at primary --cache-holds indirect
)";

/// The pictures as `render` makes them.
constexpr const char* kFinished = R"(
preview: --preset preview
standard: --preset standard
final: --preset final
)";

struct Preset {
  std::string_view name;
  const char*
      rows;  ///< lines as those of --plan; each with both presets of the paper, or that which it names
  std::vector<int> train_steps;  ///< empty: the rows are named runs
  int seeds = 3;
  std::vector<int> plain_spp = {};
};

const Preset kPresets[] = {
    {"finished", kFinished, {}, 2, {4, 8, 32, 128}},
    {"paper-table1", kEqualMemory, kTableSteps},
    {"paper-table2", kHashSizes, kTableSteps},
    {"paper-steps", kEqualMemory, kFigureSteps},
    {"paper-adaptive", kResolutions, kFigureSteps},
    {"paper-inputs", kNetworkInputs, kFigureSteps},
    {"paper-extra", kExtra, kTableSteps},
};

std::vector<SweepBlock> blocks_of(const Preset& preset) {
  std::istringstream lines(preset.rows);
  const std::vector<NamedRun> rows = parse_runs(lines);
  std::vector<SweepBlock> blocks;
  if (preset.train_steps.empty()) {
    for (const NamedRun& row : rows) blocks.push_back({.row = row.name, .run = row.flags});
    return blocks;
  }
  for (const char* paper : kPaperPresets) {
    for (const NamedRun& row : rows) {
      const std::string* own = find_flag(row.flags, "--preset");
      if (own && *own != paper) continue;
      FlagValues flags = {{"--preset", paper}};
      for (const auto& [flag, value] : row.flags) set_flag(flags, flag, value);
      blocks.push_back({.row = row.name, .base = flags, .train_steps = preset.train_steps});
    }
  }
  return blocks;
}

}  // namespace

std::vector<SweepBlock> default_rows() {
  // The preset's own samples and steps in the middle, and about a third and four times as much work.
  return {{.row = "bare", .base = {{"--preset", "bare"}}, .train_steps = kDefaultSteps},
          {.row = "standard",
           .base = {{"--preset", "standard"}},
           .axes = {{"--spp", {"2", "7", "28"}}},
           .train_steps = {128, 512, 2048}}};
}

std::vector<std::string_view> sweep_preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  for (const auto& choice : renderer::kEnumNames<renderer::CachePreset>) names.push_back(choice.name);
  return names;
}

SweepPreset sweep_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name == name) return {blocks_of(preset), preset.seeds, preset.plain_spp};
  }
  return {};
}

}  // namespace gatelight::apps
