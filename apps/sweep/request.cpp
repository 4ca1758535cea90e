#include "apps/sweep/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

#include "apps/settings/option_table.h"
#include "apps/sweep/flag_values.h"
#include "apps/sweep/presets.h"
#include "apps/sweep/references.h"
#include "apps/terminal/errors.h"
#include "base/nearest_word.h"

namespace gatelight::apps {
namespace {

constexpr IntegerRange kSteps{1, std::numeric_limits<int>::max()};
constexpr IntegerRange kSpp{1, 1 << 24};
constexpr IntegerRange kSeeds{1, 1000};
constexpr IntegerRange kSeed{0, 4294967295};

const std::vector<int> kDefaultPlainSpp = {1, 4, 16, 64};
constexpr const char* kDefaultCacheSpp = "4";

/// With any of these a row named after a preset of `render` would not be what its name promises.
constexpr const char* kNoRowFlags[] = {"--denoiser", "--view", "--query-at", "--cache-holds"};

/// `sweep` has flags of these names with lists or more presets.
constexpr const char* kOwnFlags[] = {"--train-steps", "--spp", "--preset"};

struct Instead {
  const char* flag;
  const char* use;
};
constexpr Instead kInstead[] = {{"--train-steps", "--train-steps LIST"},
                                {"--spp", "--cache-spp LIST, and --spp LIST for integrators without a cache"},
                                {"--seed", "--seeds N"}};

template <std::size_t N>
bool contains(const char* const (&list)[N], const std::string& word) {
  return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

bool is_base_flag(const std::string& flag) {
  const std::vector<std::string>& names = base_flag_names();
  return std::find(names.begin(), names.end(), flag) != names.end();
}

/// Whether `sweep` has a flag of its own that varies this one.
bool has_axis(const std::string& flag) {
  return std::any_of(std::begin(kAxisFlags), std::end(kAxisFlags),
                     [&](const AxisFlag& f) { return flag == f.varies; });
}

void check_vary(const std::string& flag) {
  for (const Instead& other : kInstead) {
    if (flag == other.flag) throw BadOption({"vary", flag, "has its own flag", other.use});
  }
  if (option_names([](const Option& option) {
        return option.marks.stage == OptionStage::load;
      }).contains(flag.substr(2))) {
    throw BadOption({"vary", flag, "decides which scene is loaded", "one value for all cells"});
  }
  if (!has_axis(flag) && flag != "--preset" && !is_base_flag(flag)) {
    std::vector<std::string> names = base_flag_names();
    for (std::string& name : names) name.erase(0, 2);
    throw BadOption({"vary", flag,
                     "is not a flag of render that affects a picture, see gatelight render --help-all", "",
                     did_you_mean(flag.substr(2), names)});
  }
}

/// By what each flag is set.
using Setters = std::map<std::string, std::string>;

/// Throws BadOption for a flag that something else sets too.
void require_free(const Setters& setters, const std::string& flag, const std::string& given_as,
                  const std::string& value) {
  const auto other = setters.find(flag);
  if (other == setters.end()) return;
  throw BadOption({given_as, value, fmt::format("is set by `{}` too", other->second), "one of them"});
}

/// Each row must be what its name promises, so nothing else may set its flags.
Setters setters_of_rows(const std::vector<SweepBlock>& rows) {
  // The preset of `render` in each row decides the integrator.
  Setters setters = {{"--integrator", "preset"}};
  for (const SweepBlock& row : rows) {
    for (const auto& [flag, value] : row.base) setters.emplace(flag, "preset");
    for (const auto& [flag, value] : row.run.value_or(FlagValues())) setters.emplace(flag, "preset");
  }
  return setters;
}

/// Adds the axes to the setters.
std::vector<SweepAxis> read_axes(const SweepArguments& words, Setters& setters) {
  std::vector<SweepAxis> axes;
  const auto add = [&](const std::string& given_as, SweepAxis axis) {
    require_free(setters, axis.flag, given_as, axis.flag);
    setters.emplace(axis.flag, given_as);
    axes.push_back(std::move(axis));
  };
  for (const auto& [flag, text] : words.axes) {
    const std::string name = flag.name + 2;
    add(name, {flag.varies, split_values(name, text, flag.varies)});
  }
  for (const std::string& text : words.vary) {
    SweepAxis axis = parse_vary(text);
    check_vary(axis.flag);
    add("vary", std::move(axis));
  }
  return axes;
}

/// Reads "SCENE:NAME=VALUE", the value of a flag for one scene.
void read_scene_flag(const std::string& text, const Setters& setters, SweepRequest& request) {
  const std::size_t equals = text.find('=');
  const std::size_t colon = equals == std::string::npos ? equals : text.rfind(':', equals);
  if (colon == std::string::npos || equals < colon + 2) {
    throw BadOption({"for", text, "", "SCENE:NAME=VALUE with the name of a flag of render"});
  }
  const std::string name = text.substr(0, colon);
  const auto scene = std::find_if(request.scenes.begin(), request.scenes.end(),
                                  [&](const SweepScene& s) { return s.name == name || s.file == name; });
  if (scene == request.scenes.end()) {
    std::vector<std::string_view> names;
    for (const SweepScene& s : request.scenes) names.push_back(s.name);
    refuse_choice("for", name, join_names(names));
  }
  const std::string word = text.substr(colon + 1, equals - colon - 1);
  const std::string flag = word.rfind("--", 0) == 0 ? word : fmt::format("--{}", word);
  if (flag == "--seed" || !is_base_flag(flag)) {
    throw BadOption({"for", flag, "is not a flag that applies to all cells of a scene"});
  }
  require_free(setters, flag, "for", flag);
  set_flag(scene->flags, flag, text.substr(equals + 1));
}

bool names_flag(const SweepBlock& block, const std::string& flag) {
  return find_flag(block.base, flag) || std::any_of(block.axes.begin(), block.axes.end(),
                                                    [&](const SweepAxis& axis) { return axis.flag == flag; });
}

void add_defaults(SweepBlock& block) {
  // A preset of `render` sets both.
  if (names_flag(block, "--preset")) return;
  if (!names_flag(block, "--integrator")) block.base.emplace_back("--integrator", "nrc");
  if (!names_flag(block, "--spp")) block.base.emplace_back("--spp", kDefaultCacheSpp);
}

void read_seeds(const SweepArguments& words, int seeds, SweepRequest& request) {
  request.seeds = seeds;
  if (!words.seeds.empty()) request.seeds = static_cast<int>(parse_integer("seeds", words.seeds, kSeeds));
  if (const std::string* seed = find_flag(words.base, "--seed")) {
    request.first_seed = static_cast<std::uint32_t>(parse_integer("seed", *seed, kSeed));
  }
  const std::uint64_t last =
      std::uint64_t{request.first_seed} + static_cast<std::uint64_t>(request.seeds) - 1;
  if (last > static_cast<std::uint64_t>(kSeed.max)) {
    throw BadOption({"seed", fmt::format("{}", request.first_seed),
                     fmt::format("is the first of {} seeds", request.seeds),
                     fmt::format("none beyond {}", kSeed.max)});
  }
  for (const std::uint32_t seed : kReferenceSeeds) {
    if (seed < request.first_seed || seed > last) continue;
    throw BadOption(
        {"seed", fmt::format("{}", seed), "is the seed of the references", "other seeds for the cells"});
  }
}

/// Whether no flag selects the pictures.
bool wants_default_rows(const SweepArguments& words) {
  return words.preset.empty() && words.axes.empty() && words.vary.empty() && words.runs.empty() &&
         words.plans.empty() &&
         std::none_of(std::begin(kNoRowFlags), std::end(kNoRowFlags),
                      [&](const char* flag) { return find_flag(words.base, flag); });
}

/// A block for each named run, those of files first.
std::vector<SweepBlock> read_named_runs(const SweepArguments& words) {
  std::vector<NamedRun> runs;
  for (const std::string& file : words.plans) {
    for (const NamedRun& run : read_runs(file)) runs.push_back(run);
  }
  for (const std::string& text : words.runs) runs.push_back(parse_run(text));
  std::vector<SweepBlock> blocks;
  for (const NamedRun& run : runs) {
    for (const auto& [flag, value] : run.flags) {
      if (contains(kOwnFlags, flag) || has_axis(flag) || (flag != "--seed" && is_base_flag(flag))) continue;
      throw BadOption({"run", flag, fmt::format("in '{}' does not affect a picture", run.name)});
    }
    blocks.push_back({.row = run.name, .run = run.flags});
  }
  return blocks;
}

std::vector<std::string> find_base_flags() {
  std::vector<std::string> names;
  RenderSettings settings;
  for (const Option& option : option_table(settings)) {
    if (!option.marks.in_sweep || option.positional || option.unit.empty()) continue;
    const std::string flag = option.flag();
    const bool axis = std::any_of(std::begin(kAxisFlags), std::end(kAxisFlags),
                                  [&](const AxisFlag& f) { return flag == f.name; });
    if (!axis && !contains(kOwnFlags, flag)) names.push_back(flag);
  }
  return names;
}

/// Names scenes by their files, with the folder where two files have the same name. Throws BadOption for a
/// file that is named twice.
std::vector<SweepScene> name_scenes(const std::vector<std::string>& files) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& file : files) {
    paths.push_back(std::filesystem::absolute(file).lexically_normal());
    if (std::count(paths.begin(), paths.end(), paths.back()) > 1)
      throw BadOption({"SCENE", file, "is named twice", "different scenes"});
  }
  std::vector<SweepScene> scenes;
  std::map<std::string, int> names;
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::string name = paths[i].stem().string();
    if (std::count_if(paths.begin(), paths.end(), [&](const auto& p) { return p.stem() == name; }) > 1)
      name = fmt::format("{}-{}", paths[i].parent_path().filename().string(), name);
    const int count = ++names[name];
    if (count > 1) name += fmt::format("-{}", count);
    scenes.push_back({std::move(name), files[i], {}});
  }
  return scenes;
}

}  // namespace

const std::vector<std::string>& base_flag_names() {
  static const std::vector<std::string> names = find_base_flags();
  return names;
}

SweepRequest make_request(const SweepArguments& words) {
  SweepRequest request;
  request.scenes = name_scenes(words.scenes);
  const SweepPreset rows = sweep_preset(words.preset);
  request.blocks = rows.blocks;
  const bool preset = !request.blocks.empty();
  FlagValues base = words.base;
  drop_flag(base, "--seed");
  if (!words.preset.empty() && !preset) {
    const std::vector<std::string_view> names = sweep_preset_names();
    if (std::find(names.begin(), names.end(), words.preset) == names.end()) {
      refuse_choice("preset", words.preset, join_names(names));
    }
    base.emplace_back("--preset", words.preset);
  }
  const std::vector<SweepBlock> runs = read_named_runs(words);
  request.blocks.insert(request.blocks.end(), runs.begin(), runs.end());
  if (wants_default_rows(words)) {
    request.blocks = default_rows();
  } else if (request.blocks.empty()) {
    request.blocks.push_back({.train_steps = kDefaultSteps});
  }
  Setters setters = preset ? setters_of_rows(request.blocks) : Setters();
  const std::vector<SweepAxis> axes = read_axes(words, setters);
  for (const std::string& text : words.scene_flags) read_scene_flag(text, setters, request);
  for (const auto& [flag, value] : base) require_free(setters, flag, flag.substr(2), value);
  for (SweepBlock& block : request.blocks) {
    block.base.insert(block.base.end(), base.begin(), base.end());
    block.axes.insert(block.axes.end(), axes.begin(), axes.end());
    if (block.run && !words.train_steps.empty())
      throw BadOption({"train-steps", "", "named runs have their own", "it in the flags of a `run`"});
    if (block.run) continue;
    if (!words.train_steps.empty())
      block.train_steps = split_integers("train-steps", words.train_steps, kSteps);
    add_defaults(block);
  }
  request.allow_external = words.allow_external;
  request.plain_spp = rows.plain_spp.empty() ? kDefaultPlainSpp : rows.plain_spp;
  if (!words.spp.empty()) request.plain_spp = split_integers("spp", words.spp, kSpp);
  // The paper has no rows without a cache.
  request.plain = !words.no_plain && (!preset || !words.spp.empty() || !rows.plain_spp.empty());
  read_seeds(words, preset ? rows.seeds : 1, request);
  return request;
}

}  // namespace gatelight::apps
