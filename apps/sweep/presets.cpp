#include "apps/sweep/presets.h"

#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

/// Passes and steps of finished pictures: the preset's own in the middle, and about a third and four times
/// as much work.
const std::vector<std::string> kStandardSpp = {"2", "7", "28"};
const std::vector<int> kStandardSteps = {128, 512, 2048};

/// The step counts of the paper: 128 in its tables, from 8 on in its figure.
const std::vector<int> kTableSteps = {128};
const std::vector<int> kFigureSteps = {8, 16, 32, 64, 128};

const char* const kPaperPresets[] = {"paper-nao", "paper-nrc"};

// The paper measures the hash grid with tiny-cuda-nn, which updates every entry in every step.
const FlagValues kHashGrid = {{"--encoding", "hashgrid"}, {"--update", "dense"}};
const FlagValues kSparseHashGrid = {{"--encoding", "hashgrid"}, {"--update", "sparse"}};

// By default GATE reads the normal with other resolutions than the paper's.
const std::pair<std::string, std::string> kNoNormal = {"--normal-input", "off"};
const FlagValues kUniform = {{"--resolution", "uniform"}, kNoNormal};

struct Row {
  const char* name;
  FlagValues flags;
};

FlagValues joined(FlagValues flags, const FlagValues& more) {
  for (const auto& [flag, value] : more) set_flag(flags, flag, value);
  return flags;
}

/// Adds a block for each row, on top of a preset of `render`.
void add_rows(std::vector<SweepBlock>& blocks, const char* preset, const std::vector<Row>& rows,
              const std::vector<int>& steps) {
  for (const Row& row : rows)
    blocks.push_back(
        {.row = row.name, .base = joined({{"--preset", preset}}, row.flags), .train_steps = steps});
}

std::vector<SweepBlock> both(const std::vector<Row>& rows, const std::vector<int>& steps) {
  std::vector<SweepBlock> blocks;
  for (const char* preset : kPaperPresets) add_rows(blocks, preset, rows, steps);
  return blocks;
}

/// GATE and the hash grid at comparable memory.
std::vector<Row> equal_memory() {
  const FlagValues memory = {{"--cache-memory", "same-as-gate"}};
  return {{"gate", {}},
          {"hash grid", joined(kHashGrid, memory)},
          {"hash grid, sparse updates", joined(kSparseHashGrid, memory)}};
}

/// Sizes of the hash grid: L is as large as GATE, M half of it, S less than 1 MB.
std::vector<Row> hash_sizes() {
  return {{"gate", {}},
          {"hash grid L", joined(kHashGrid, {{"--cache-memory", "same-as-gate"}})},
          {"hash grid M", joined(kHashGrid, {{"--cache-memory", "same-as-gate/2"}})},
          {"hash grid S", joined(kHashGrid, {{"--cache-memory", "0.91"}})}};
}

std::vector<SweepBlock> inputs() {
  std::vector<SweepBlock> blocks;
  // Occlusion does not depend on the albedo.
  add_rows(blocks, "paper-nao",
           {{"gate", {{"--normal-input", "off"}}}, {"gate, normal", {{"--normal-input", "on"}}}},
           kFigureSteps);
  add_rows(blocks, "paper-nrc",
           {{"gate", {{"--normal-input", "off"}, {"--albedo-input", "off"}}},
            {"gate, normal", {{"--normal-input", "on"}, {"--albedo-input", "off"}}},
            {"gate, albedo", {{"--normal-input", "off"}, {"--albedo-input", "on"}}},
            {"gate, normal and albedo", {{"--normal-input", "on"}, {"--albedo-input", "on"}}}},
           kFigureSteps);
  return blocks;
}

/// Choices that the paper leaves open or does not measure; each row changes one.
std::vector<SweepBlock> extra() {
  std::vector<SweepBlock> blocks = both({{"as in the paper", {}},
                                         {"storage per triangle", {{"--storage", "per-triangle"}}},
                                         {"counters per node", {{"--feature-step", "per-node"}}},
                                         {"no candidates", {{"--candidates", "1"}}},
                                         {"4 samples per point", {{"--samples-per-point", "4"}}},
                                         {"fp16 features", {{"--feature-precision", "fp16"}}},
                                         {"stack of 1", {{"--stack", "adaptive"}}},
                                         {"stack of 3", {{"--stack", "adaptive,adaptive/3,1"}}},
                                         {"clusters", joined(kUniform, {{"--cluster", "auto"}})},
                                         {"uniform, no clusters", kUniform}},
                                        kTableSteps);
  // The picture itself, which the paper does not show.
  const auto picture = [](const FlagValues& flags) {
    return joined({{"--view", "final"}, {"--spp", "4"}}, flags);
  };
  add_rows(blocks, "paper-nrc",
           {{"picture, primary", picture({{"--query-at", "primary"}})},
            {"picture, gather", picture({{"--query-at", "gather"}})},
            {"picture, holds no-delta", picture({{"--query-at", "primary"}, {"--cache-holds", "no-delta"}})},
            {"picture, holds indirect", picture({{"--query-at", "primary"}, {"--cache-holds", "indirect"}})}},
           kTableSteps);
  return blocks;
}

/// The presets of finished pictures as `render` makes them.
std::vector<SweepBlock> finished() {
  std::vector<SweepBlock> blocks;
  for (const char* preset : {"preview", "standard", "final"})
    blocks.push_back({.row = preset, .run = {{{"--preset", preset}}}});
  return blocks;
}

struct Preset {
  std::string_view name;
  std::vector<SweepBlock> (*make)();
  int seeds = 3;
  std::vector<int> plain_spp = {};
};

const Preset kPresets[] = {
    {"finished", finished, 2, {4, 8, 32, 128}},
    {"paper-table1", [] { return both(equal_memory(), kTableSteps); }},
    {"paper-table2", [] { return both(hash_sizes(), kTableSteps); }},
    {"paper-steps", [] { return both(equal_memory(), kFigureSteps); }},
    {"paper-adaptive",
     [] {
       return both({{"fixed R = 4", {{"--resolution", "fixed:4"}, kNoNormal}},
                    {"adaptive, paper's rule", {{"--resolution", "paper"}}},
                    {"adaptive, uniform", kUniform}},
                   kFigureSteps);
     }},
    {"paper-inputs", inputs},
    {"paper-extra", extra},
};

}  // namespace

std::vector<SweepBlock> default_rows() {
  return {{.row = "bare", .base = {{"--preset", "bare"}}, .train_steps = kDefaultSteps},
          {.row = "standard",
           .base = {{"--preset", "standard"}},
           .axes = {{"--spp", kStandardSpp}},
           .train_steps = kStandardSteps}};
}

std::vector<std::string_view> sweep_preset_names() {
  std::vector<std::string_view> names;
  for (const Preset& preset : kPresets) names.push_back(preset.name);
  for (const auto& choice : renderer::kEnumNames<renderer::CachePreset>) names.push_back(choice.name);
  return names;
}

SweepPreset sweep_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name == name) return {preset.make(), preset.seeds, preset.plain_spp};
  }
  return {};
}

}  // namespace gatelight::apps
