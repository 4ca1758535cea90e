#include "apps/sweep/advise.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/sweep/cell_record.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

std::string point_text(const ordered_json& cell) {
  std::string text;
  if (!cell.at("train_steps").is_null()) text = fmt::format("{} steps, ", cell["train_steps"].get<int>());
  return text + fmt::format("{} spp", cell.at("spp").get<int>());
}

bool same(const Configuration& a, const Configuration& b) {
  return a.scene == b.scene && a.reference_id == b.reference_id && a.series == b.series && a.point == b.point;
}

/// Whether errors of both can be compared.
bool comparable(const Configuration& a, const Configuration& b) {
  return a.scene == b.scene && a.reference_id == b.reference_id;
}

/// "path", or "path, max-depth 2". Where a scene has several references of a kind, the text has the axes that
/// all of `group` share and no others have.
std::string reference_text(const std::vector<Configuration>& group, const std::vector<Configuration>& all) {
  const Configuration& first = group.front();
  std::vector<const Configuration*> others;
  for (const Configuration& c : all) {
    if (c.scene == first.scene && c.reference == first.reference && !comparable(c, first))
      others.push_back(&c);
  }
  if (others.empty()) return first.reference;
  std::string text;
  for (const auto& [axis, value] : first.axes) {
    const auto has = [&the_axis = axis, &the_value = value](const Configuration& c) {
      const std::string* of_other = find_flag(c.axes, the_axis);
      return of_other && *of_other == the_value;
    };
    const bool of_all = std::all_of(group.begin(), group.end(), has);
    if (of_all && std::none_of(others.begin(), others.end(), [&](const Configuration* c) { return has(*c); }))
      text += fmt::format(", {} {}", axis, value);
  }
  return first.reference + (text.empty() ? fmt::format(", reference {}", first.reference_id) : text);
}

/// Adds the values of a cell to the means.
void add(Configuration& c, double error, double seconds) {
  c.smallest_error = c.seeds == 0 ? error : std::min(c.smallest_error, error);
  c.largest_error = c.seeds == 0 ? error : std::max(c.largest_error, error);
  ++c.seeds;
  c.error += (error - c.error) / c.seeds;
  c.seconds += (seconds - c.seconds) / c.seeds;
}

std::string limits_text(const AdviceLimits& limits) {
  std::string text;
  if (limits.max_error) text = fmt::format("FLIP of at most {:.4g} with every seed", *limits.max_error);
  if (limits.max_error && limits.max_seconds) text += " and ";
  if (limits.max_seconds) text += fmt::format("time of at most {:.4g} s", *limits.max_seconds);
  return text;
}

std::string describe(const Configuration& c) {
  std::string text = fmt::format("{}, {}: FLIP {:.4f}", c.series, c.point, c.error);
  if (c.seeds > 1) {
    text += fmt::format(" ({:.4f} to {:.4f} over {} seeds)", c.smallest_error, c.largest_error, c.seeds);
  }
  return text + fmt::format(", {:.3g} s", c.seconds);
}

}  // namespace

std::vector<Configuration> configurations(const ordered_json& results) {
  std::vector<Configuration> found;
  for (const ordered_json& cell : results.at("cells")) {
    if (!is_done(cell) || !cell.at("errors").at("flip").is_number()) continue;
    Configuration c;
    c.scene = cell.at("scene").get<std::string>();
    c.reference = cell.at("reference").get<std::string>();
    c.reference_id = cell.at("reference_id").get<std::string>();
    c.series = cell.at("series").get<std::string>();
    c.point = point_text(cell);
    auto at = std::find_if(found.begin(), found.end(), [&](const Configuration& o) { return same(o, c); });
    if (at == found.end()) {
      c.command = cell.at("command").get<std::string>();
      for (const auto& [axis, value] : cell.at("axes").items())
        c.axes.emplace_back(axis, value.get<std::string>());
      at = found.insert(found.end(), c);
    }
    add(*at, cell["errors"]["flip"].get<double>(), cell.at("seconds").at("total").get<double>());
  }
  return found;
}

Advice choose(const std::vector<Configuration>& candidates, const AdviceLimits& limits) {
  // The worst seed counts, because the command has only one of them.
  const auto good = [&](const Configuration& c) {
    return !limits.max_error || c.largest_error <= *limits.max_error;
  };
  const auto fast = [&](const Configuration& c) {
    return !limits.max_seconds || c.seconds <= *limits.max_seconds;
  };
  const auto faster = [](const Configuration& a, const Configuration& b) { return a.seconds < b.seconds; };
  const auto better = [&](const Configuration& a, const Configuration& b) {
    return limits.max_error ? a.largest_error < b.largest_error : a.error < b.error;
  };
  std::vector<Configuration> chosen;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(chosen),
               [&](const Configuration& c) { return good(c) && fast(c); });
  if (!chosen.empty()) {
    const auto best = limits.max_error ? std::min_element(chosen.begin(), chosen.end(), faster)
                                       : std::min_element(chosen.begin(), chosen.end(), better);
    return {*best, true};
  }
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(chosen), fast);
  if (chosen.empty()) return {*std::min_element(candidates.begin(), candidates.end(), faster), false};
  return {*std::min_element(chosen.begin(), chosen.end(), better), false};
}

AdviceReport give_advice(const ordered_json& results, const AdviceLimits& limits) {
  const std::vector<Configuration> all = configurations(results);
  if (all.empty()) return {"", "no cell of this sweep is done"};
  std::vector<std::string> unmet;
  std::string text = fmt::format("{}, without loading the scene and building\n", limits_text(limits));
  std::vector<Configuration> rest = all;
  while (!rest.empty()) {
    const Configuration first = rest.front();
    std::vector<Configuration> group;
    for (const Configuration& c : rest) {
      if (comparable(c, first)) group.push_back(c);
    }
    std::erase_if(rest, [&](const Configuration& c) { return comparable(c, first); });
    const Advice advice = choose(group, limits);
    if (!advice.met) unmet.push_back(fmt::format("{} ({})", first.scene, reference_text(group, all)));
    text += fmt::format("{} ({}): {}{}\n  {}\n", first.scene, reference_text(group, all),
                        advice.met ? "" : fmt::format("none of {} met it; the nearest is ", group.size()),
                        describe(advice.best), advice.best.command);
  }
  if (unmet.empty()) return {text, ""};
  return {text, fmt::format("no configuration of {} has a {}", fmt::join(unmet, ", "), limits_text(limits))};
}

}  // namespace gatelight::apps
