#include "apps/sweep/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "apps/reports/recipe.h"
#include "apps/settings/complete_settings.h"
#include "apps/settings/flags.h"
#include "apps/sweep/planned.h"
#include "apps/sweep/references.h"
#include "apps/terminal/errors.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using renderer::Integrator;

constexpr const char* kSameAsGate = "same-as-gate";
constexpr const char* kDenoiser = "--denoiser";

/// Stands for the scene, because settings are read before a scene is loaded. It is no file.
const std::string kNoScene = "scene";

ReferenceKind reference_kind(const renderer::RenderOptions& o) {
  if (o.integrator == Integrator::ao || o.integrator == Integrator::nao) return ReferenceKind::ao;
  const bool bare = o.integrator == Integrator::nrc && o.cache.view == renderer::CacheOutput::cache;
  return bare ? ReferenceKind::cache : ReferenceKind::path;
}

/// Drops flags that would be refused because they have no effect with the others. A named run chooses its
/// integrator itself.
RenderSettings settle(FlagValues& flags, bool named = false) {
  RenderSettings settings;
  for (bool dropped = true; dropped;) {
    dropped = false;
    settings = parse_render_arguments(kNoScene, words_of(flags));
    const renderer::RenderOptions& o = settings.render;
    const bool has_cache = renderer::uses_cache(o.integrator);
    const auto replace = [&, named](bool chooses, const char* flag, const std::string& value) {
      if (!chooses || named) return;
      set_flag(flags, flag, value);
      dropped = true;
    };
    // Axes do not choose: they compare integrators with and without a cache.
    replace(o.choose_integrator, "--integrator", renderer::enum_name(o.integrator));
    replace(o.cache.choose_device && has_cache, "--device", o.cache.device);
    // The pictures of a series have the first samples of one render.
    replace(o.sampler == renderer::SamplerKind::screen && !has_cache, "--sampler", "sobol");
    if (dropped) continue;
    for (const std::string& name : options_without_effect(settings)) dropped |= drop_flag(flags, "--" + name);
    if (!has_cache && !named) dropped |= drop_flag(flags, "--spp");
  }
  if (!settings.exposure) {
    throw BadOption({"exposure", "auto", "differs between pictures", "a number of stops for a sweep"});
  }
  // With only a preset, `render` would choose an exposure for each picture, and another curve.
  if (find_flag(flags, "--preset")) {
    for (const auto& [flag, value] : {std::pair("--exposure", "0"), {"--tonemap", "none"}}) {
      if (!find_flag(flags, flag)) set_flag(flags, flag, value);
    }
  }
  complete_settings(settings);
  // A machine without a denoiser must not give other pictures.
  renderer::DenoiserKind& denoiser = settings.render.denoise.denoiser;
  if (denoiser == renderer::DenoiserKind::automatic) denoiser = renderer::DenoiserKind::oidn;
  return settings;
}

/// Removes "--cache-memory same-as-gate[/DIVISOR]" from the flags. Returns the divisor.
std::optional<double> take_same_as_gate(FlagValues& flags) {
  const std::string* value = find_flag(flags, "--cache-memory");
  if (!value || value->rfind(kSameAsGate, 0) != 0) return std::nullopt;
  const std::string rest = value->substr(std::string(kSameAsGate).size());
  double divisor = 1.0;
  if (!rest.empty()) {
    if (rest.front() != '/') {
      throw BadOption(
          {"cache-memory", *value, "", fmt::format("{} or {}/DIVISOR", kSameAsGate, kSameAsGate)});
    }
    divisor = parse_real("cache-memory", rest.substr(1), kPositive);
  }
  drop_flag(flags, "--cache-memory");
  return divisor;
}

/// Tells settings apart before the scene is loaded. Of a preset only its values count.
std::string options_text(RenderSettings settings) {
  settings.preset.reset();
  return fmt::format("{}\nmemory-limit {}\n", dump_options(settings), settings.render.memory_limit_bytes);
}

/// The common flags with those of a run's own flags that decide its reference, so that both are compared
/// with the same one.
FlagValues flags_of_reference(FlagValues common, const FlagValues& own, ReferenceKind kind) {
  const auto reference = [kind](FlagValues flags) {
    take_same_as_gate(flags);
    return options_text(reference_settings(settle(flags, true), kind, 1));
  };
  for (const auto& [flag, value] : own) {
    FlagValues more = common;
    set_flag(more, flag, value);
    if (reference(more) != reference(common)) common = std::move(more);
  }
  return common;
}

std::string series_key(const PlannedSeries& series) {
  std::string key = options_text(cell_settings(series, kNoScene, 0, 1)) + named_text(series);
  if (series.memory)
    key +=
        fmt::format("memory of gate / {}\n{}", series.memory->divisor, options_text(series.memory->settings));
  return key;
}

std::string name_of_flag(const std::string& flag) {
  return flag.substr(2);
}

class Planner {
 public:
  Planner(const SweepRequest& request, const FlagValues& scene_flags)
      : request_(request), scene_flags_(scene_flags) {
    for (const SweepBlock& block : request.blocks) {
      for (const SweepAxis& axis : block.axes) {
        const bool known = std::find(axes_.begin(), axes_.end(), axis.flag) != axes_.end();
        if (axis.values.size() > 1 && !known) axes_.push_back(axis.flag);
      }
    }
  }

  std::vector<PlannedSeries> plan() {
    for (const SweepBlock& block : request_.blocks) {
      require_few(block);
      FlagValues base = block.base;
      for (const auto& [flag, value] : scene_flags_) set_flag(base, flag, value);
      combine(block, base, 0);
    }
    name_integrators();
    make_labels();
    return std::move(series_);
  }

 private:
  /// More combinations are a mistake: cells of a minute each would take a week.
  static void require_few(const SweepBlock& block) {
    constexpr double kMax = 10000;
    double count = 1.0;
    for (const SweepAxis& axis : block.axes) count *= static_cast<double>(axis.values.size());
    if (count > kMax) {
      throw BadOption({"vary", "", fmt::format("there are {:.0f} combinations of values", count),
                       fmt::format("at most {:.0f}", kMax)});
    }
  }

  void combine(const SweepBlock& block, const FlagValues& flags, std::size_t axis) {
    if (axis == block.axes.size()) {
      add(block, flags);
      return;
    }
    for (const std::string& value : block.axes[axis].values) {
      FlagValues more = flags;
      set_flag(more, block.axes[axis].flag, value);
      combine(block, more, axis + 1);
    }
  }

  void add(const SweepBlock& block, const FlagValues& common) {
    FlagValues flags = common;
    if (block.run) {
      for (const auto& [flag, value] : *block.run) set_flag(flags, flag, value);
    }
    const PlannedSeries series = make_series(block, flags);
    if (series.named) {
      // Below the integrator with which it is compared.
      add_plain(block, common, series);
      keep(series);
    } else {
      keep(series);
      if (series.has_cache()) add_plain(block, flags, series);
    }
  }

  /// Adds the integrator without a cache beside a series.
  void add_plain(const SweepBlock& block, const FlagValues& flags, const PlannedSeries& series) {
    // None renders the view of the cache.
    if (!request_.plain || series.reference == ReferenceKind::cache) return;
    FlagValues plain = block.run ? flags_of_reference(flags, *block.run, series.reference) : flags;
    drop_flag(plain, kDenoiser);
    // The size of the preset stays, because pictures are compared with each other.
    const renderer::RenderOptions& o = series.settings.render;
    if (drop_flag(plain, "--preset")) set_flag(plain, "--size", fmt::format("{}x{}", o.width, o.height));
    set_flag(plain, "--integrator", series.reference == ReferenceKind::ao ? "ao" : "path");
    const auto keep_plain = [&] { keep(make_series({.axes = block.axes}, plain)); };
    keep_plain();
    if (!is_denoised(series)) return;
    set_flag(plain, kDenoiser, denoiser_of(series));
    keep_plain();
  }

  PlannedSeries make_series(const SweepBlock& block, const FlagValues& requested) const {
    PlannedSeries series;
    series.named = block.run.has_value();
    series.flags = requested;
    const std::optional<double> divisor = take_same_as_gate(series.flags);
    FlagValues gate = series.flags;
    series.settings = settle(series.flags, series.named);
    series.settings.load.allow_external = request_.allow_external;
    FlagValues named = series.flags;
    const bool hash = series.settings.render.cache.encoding == neural::FeatureEncoding::hash_grid;
    if (divisor && series.has_cache() && hash) {
      // Flags that decide the memory of GATE also decide the memory and the name of this series.
      set_flag(gate, "--encoding", "gate");
      series.memory = GateMemory{settle(gate, series.named), *divisor};
      for (const auto& [flag, value] : gate) set_flag(named, flag, value);
      set_flag(named, "--cache-memory", *find_flag(requested, "--cache-memory"));
    }
    if (!block.row.empty()) series.axes.emplace_back("row", block.row);
    for (const std::string& axis : axes_) {
      const std::string* value = find_flag(named, axis);
      if (value) series.axes.emplace_back(name_of_flag(axis), *value);
    }
    series.reference = reference_kind(series.settings.render);
    series.points = series.has_cache() ? block.train_steps : request_.plain_spp;
    if (series.named) series.points = {0};
    return series;
  }

  /// Merges equal series, with the points of both.
  void keep(PlannedSeries series) {
    const auto [at, is_new] = by_key_.emplace(series_key(series), series_.size());
    if (is_new) {
      series_.push_back(std::move(series));
      return;
    }
    std::vector<int>& points = series_[at->second].points;
    points.insert(points.end(), series.points.begin(), series.points.end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
  }

  /// Makes axes of integrator, encoding and denoiser where they vary: integrators without a cache may be
  /// measured too, and presets decide about denoising.
  void name_integrators() {
    const std::pair<const char*, std::string (*)(const PlannedSeries&)> decided[] = {
        {"denoiser", denoiser_of}, {"encoding", encoding_of}, {"integrator", integrator_of}};
    for (const auto& [name, value_of] : decided) {
      std::set<std::string> values;
      for (const PlannedSeries& s : series_) values.insert(value_of(s));
      values.erase("");
      for (PlannedSeries& s : series_) {
        drop_flag(s.axes, name);
        const std::string value = value_of(s);
        if (values.size() > 1 && !value.empty()) s.axes.emplace(s.axes.begin(), name, value);
      }
    }
  }

  void make_labels() {
    std::map<std::string, int> seen;
    for (PlannedSeries& s : series_) {
      const std::string* row = find_flag(s.axes, "row");
      s.label = s.named ? *row : integrator_of(s);
      // A row has a name of its own.
      if (s.has_cache() && !row) s.label += fmt::format(" {}", encoding_of(s));
      if (!row && find_flag(s.axes, "denoiser") && is_denoised(s)) s.label += " denoised";
      for (const auto& [name, value] : s.axes) {
        if (name == "integrator" || name == "encoding" || name == "denoiser") continue;
        if (name != "row") s.label += fmt::format(" {} {}", name, value);
        if (name == "row" && !s.named) s.label += fmt::format(" {}", value);
      }
      const int count = ++seen[s.label];
      if (count > 1) s.label += fmt::format(" #{}", count);
    }
  }

  static bool is_denoised(const PlannedSeries& s) {
    return s.settings.render.denoise.denoiser != renderer::DenoiserKind::none;
  }
  static std::string denoiser_of(const PlannedSeries& s) {
    return renderer::enum_name(s.settings.render.denoise.denoiser);
  }
  static std::string integrator_of(const PlannedSeries& s) {
    const renderer::RenderOptions& o = s.settings.render;
    return o.choose_integrator ? "auto" : renderer::enum_name(o.integrator);
  }
  /// Empty without a cache.
  static std::string encoding_of(const PlannedSeries& s) {
    return s.has_cache() ? renderer::enum_name(s.settings.render.cache.encoding) : "";
  }

  const SweepRequest& request_;
  const FlagValues& scene_flags_;
  std::vector<std::string> axes_;  ///< flags with several values
  std::vector<PlannedSeries> series_;
  std::map<std::string, std::size_t> by_key_;
};

std::string plural(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::size_t SweepPlan::run_count() const {
  std::size_t count = 0;
  for (const PlannedScene& scene : scenes) count += scene.series.size();
  return count * seeds.size();
}

std::size_t SweepPlan::cell_count() const {
  std::size_t points = 0;
  for (const PlannedScene& scene : scenes) {
    for (const PlannedSeries& s : scene.series) points += s.points.size();
  }
  return points * seeds.size();
}

SweepPlan make_plan(const SweepRequest& request) {
  SweepPlan plan;
  for (const SweepScene& scene : request.scenes) {
    plan.scenes.push_back({scene.name, scene.file, Planner(request, scene.flags).plan()});
  }
  for (int i = 0; i < request.seeds; ++i) {
    plan.seeds.push_back(request.first_seed + static_cast<std::uint32_t>(i));
  }
  return plan;
}

std::string plan_text(const SweepPlan& plan) {
  std::string text;
  for (const PlannedScene& scene : plan.scenes) {
    text += fmt::format("{}  {}\n", scene.name, scene.file);
    std::size_t width = 0;
    for (const PlannedSeries& s : scene.series) width = std::max(width, s.label.size());
    for (const PlannedSeries& s : scene.series) {
      const renderer::RenderOptions& o = s.settings.render;
      text += fmt::format("  {:<{}}  {}x{}", s.label, width, o.width, o.height);
      if (!s.named) text += fmt::format(", {} {}", s.has_cache() ? "steps" : "spp", fmt::join(s.points, ","));
      if (s.has_cache() || s.named) text += fmt::format(", {} spp", o.spp);
      text += fmt::format(", against {}\n", renderer::name_of(kReferenceKinds, s.reference));
    }
  }
  return text + fmt::format("{} with {}: {}, {}\n", plural(plan.scenes.size(), "scene"),
                            plural(plan.seeds.size(), "seed"), plural(plan.run_count(), "run"),
                            plural(plan.cell_count(), "cell"));
}

}  // namespace gatelight::apps
