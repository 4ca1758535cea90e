#include "apps/sweep/advise.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

Mean error_of(const MeasuredRun& run) {
  return *run.mean("errors", "flip");
}

double seconds_of(const MeasuredRun& run) {
  return run.mean("seconds", "total")->value;
}

/// "path", or where a scene has several references of a kind "path, reference ID". The names of their series
/// tell what differs.
std::string reference_text(const MeasuredRun& run, const std::vector<MeasuredRun>& all) {
  const std::string kind = run.word("reference");
  const bool several = std::any_of(all.begin(), all.end(), [&](const MeasuredRun& other) {
    return same_cells(other, run, {"scene", "reference"}) && !same_cells(other, run, {"reference_id"});
  });
  return several ? fmt::format("{}, reference {}", kind, run.word("reference_id")) : kind;
}

std::string limits_text(const AdviceLimits& limits) {
  std::string text;
  if (limits.max_error) text = fmt::format("FLIP of at most {:.4g} with every seed", *limits.max_error);
  if (limits.max_error && limits.max_seconds) text += " and ";
  if (limits.max_seconds) text += fmt::format("time of at most {:.4g} s", *limits.max_seconds);
  return text;
}

/// "nrc gate, 128 steps, 4 spp: FLIP 0.0500, 1.5 s"
std::string describe(const MeasuredRun& run) {
  const ordered_json& cell = run.cell();
  std::string text = run.word("series");
  if (!cell.at("train_steps").is_null()) text += fmt::format(", {} steps", cell["train_steps"].get<int>());
  const Mean error = error_of(run);
  text += fmt::format(", {} spp: FLIP {:.4f}", cell.at("spp").get<int>(), error.value);
  if (run.cells.size() > 1)
    text += fmt::format(" ({:.4f} to {:.4f} over {} seeds)", error.least, error.most, run.cells.size());
  return text + fmt::format(", {:.3g} s", seconds_of(run));
}

}  // namespace

Advice choose(const std::vector<MeasuredRun>& candidates, const AdviceLimits& limits) {
  // Those that are too slow are behind those with too large an error.
  const auto rank_of = [&](const MeasuredRun& run) -> std::pair<int, double> {
    const double seconds = seconds_of(run);
    // The worst seed counts, because the command has only one of them.
    const double error = limits.max_error ? error_of(run).most : error_of(run).value;
    if (limits.max_seconds && seconds > *limits.max_seconds) return {2, seconds};
    if (limits.max_error && error > *limits.max_error) return {1, error};
    return {0, limits.max_error ? seconds : error};
  };
  const auto best =
      std::min_element(candidates.begin(), candidates.end(),
                       [&](const MeasuredRun& a, const MeasuredRun& b) { return rank_of(a) < rank_of(b); });
  return {&*best, rank_of(*best).first == 0};
}

AdviceReport give_advice(const ordered_json& results, const AdviceLimits& limits) {
  std::vector<MeasuredRun> all = measured_runs(results.at("cells"));
  std::erase_if(all, [](const MeasuredRun& run) {
    return !run.mean("errors", "flip") || !run.mean("seconds", "total");
  });
  if (all.empty()) return {"", "no cell of this sweep is finished"};
  std::vector<std::string> unmet;
  std::string text = fmt::format("{}, without loading the scene and building\n", limits_text(limits));
  std::vector<MeasuredRun> rest = all;
  while (!rest.empty()) {
    const auto others =
        std::stable_partition(rest.begin(), rest.end(), [first = rest.front()](const MeasuredRun& run) {
          return same_cells(run, first, {"scene", "reference_id"});
        });
    const std::vector<MeasuredRun> group(rest.begin(), others);
    rest.erase(rest.begin(), others);
    const Advice advice = choose(group, limits);
    const std::string name =
        fmt::format("{} ({})", group.front().word("scene"), reference_text(group.front(), all));
    if (!advice.met) unmet.push_back(name);
    text += fmt::format(
        "{}: {}{}\n  {}\n", name,
        advice.met ? "" : fmt::format("none of {} is within the limits; the closest is ", group.size()),
        describe(*advice.best), advice.best->word("command"));
  }
  if (unmet.empty()) return {text, ""};
  return {text, fmt::format("no configuration of {} has a {}", fmt::join(unmet, ", "), limits_text(limits))};
}

}  // namespace gatelight::apps
