#include "apps/sweep/measured_runs.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/sweep/cell_record.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

bool equal(const ordered_json& a, const ordered_json& b, std::initializer_list<const char*> keys) {
  return std::all_of(keys.begin(), keys.end(), [&](const char* key) { return a.at(key) == b.at(key); });
}

bool same_reference(const MeasuredRun& a, const MeasuredRun& b) {
  return same_cells(a, b, {"scene", "reference_id"});
}

/// A row has a name of its own and is no baseline, even where a named run takes plain paths.
Baseline kind_of(const ordered_json& cell) {
  if (!cell.at("train_steps").is_null() || cell.at("axes").contains("row")) return Baseline::none;
  return cell.at("options").value("denoiser", "none") == "none" ? Baseline::traced : Baseline::denoised;
}

/// Where the logarithms of both lie on the line through two points.
double seconds_on_line(std::pair<double, double> a, std::pair<double, double> b, double error) {
  const double t = (std::log(error) - std::log(a.second)) / (std::log(b.second) - std::log(a.second));
  return std::exp(std::log(a.first) + t * (std::log(b.first) - std::log(a.first)));
}

std::vector<std::pair<double, double>> points_of(const std::vector<MeasuredRun>& runs,
                                                 const MeasuredRun& like, Baseline baseline,
                                                 const char* error) {
  std::vector<std::pair<double, double>> points;
  for (const MeasuredRun& run : runs) {
    if (run.baseline != baseline || !same_reference(run, like)) continue;
    const std::optional<Mean> mean = run.mean("errors", error);
    if (mean) points.emplace_back(run.mean("seconds", "total")->value, mean->value);
  }
  return points;
}

}  // namespace

bool same_cells(const MeasuredRun& a, const MeasuredRun& b, std::initializer_list<const char*> keys) {
  return equal(a.cell(), b.cell(), keys);
}

std::string MeasuredRun::word(const char* key) const {
  return cell().at(key).get<std::string>();
}

std::optional<Mean> MeasuredRun::mean(const char* object, const char* key) const {
  std::vector<double> values;
  for (const ordered_json* cell : cells) {
    const auto value = cell->at(object).find(key);
    if (value != cell->at(object).end() && value->is_number()) values.push_back(value->get<double>());
  }
  if (values.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  Mean mean{.value = 0.0, .least = *least, .most = *most, .deviation = {}};
  for (const double value : values) mean.value += value / static_cast<double>(values.size());
  if (values.size() < 3) return mean;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean.value) * (value - mean.value);
  mean.deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return mean;
}

std::vector<MeasuredRun> measured_runs(const ordered_json& cells) {
  std::vector<MeasuredRun> runs;
  for (const ordered_json& cell : cells) {
    if (!is_done(cell)) continue;
    auto at = std::find_if(runs.begin(), runs.end(), [&](const MeasuredRun& run) {
      return equal(run.cell(), cell, {"scene", "reference_id", "run"});
    });
    if (at == runs.end()) at = runs.insert(runs.end(), MeasuredRun{});
    at->cells.push_back(&cell);
  }
  for (MeasuredRun& run : runs) {
    const Baseline kind = kind_of(run.cell());
    const auto first = std::find_if(runs.begin(), runs.end(), [&](const MeasuredRun& other) {
      return kind_of(other.cell()) == kind && same_reference(other, run);
    });
    if (equal(first->cell(), run.cell(), {"series"})) run.baseline = kind;
  }
  return runs;
}

std::optional<EqualSeconds> equal_error_seconds(std::vector<std::pair<double, double>> points, double error) {
  std::erase_if(points, [](const auto& p) { return !(p.first > 0.0 && p.second > 0.0); });
  std::sort(points.begin(), points.end());
  if (points.size() < 2 || !(error > 0.0)) return std::nullopt;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const auto& [a, b] = std::pair(points[i], points[i + 1]);
    if (a.second >= error && error >= b.second && a.second > b.second)
      return EqualSeconds{seconds_on_line(a, b, error), false};
  }
  const std::size_t i = error > points.front().second ? 0 : points.size() - 2;
  const auto& [a, b] = std::pair(points[i], points[i + 1]);
  if (!(a.second > b.second && a.first < b.first)) return std::nullopt;
  return EqualSeconds{seconds_on_line(a, b, error), true};
}

void add_equal_error(ordered_json& cells) {
  const ordered_json measured = cells;
  const std::vector<MeasuredRun> runs = measured_runs(measured);
  for (const MeasuredRun& run : runs) {
    ordered_json columns;
    for (const Baseline baseline : {Baseline::traced, Baseline::denoised}) {
      const bool compared = run.baseline == Baseline::none || baseline < run.baseline;
      for (const char* error : kEqualErrors) {
        const std::optional<Mean> mean = run.mean("errors", error);
        std::optional<EqualSeconds> equal;
        if (compared && mean) equal = equal_error_seconds(points_of(runs, run, baseline, error), mean->value);
        const double seconds = run.mean("seconds", "total")->value;
        const std::string name = prefix_of(baseline) + std::string(error);
        columns["equal_seconds"][name] = equal ? ordered_json(equal->seconds) : nullptr;
        columns["times_faster"][name] =
            equal && seconds > 0.0 ? ordered_json(equal->seconds / seconds) : nullptr;
        columns["extrapolated"][name] = equal ? ordered_json(equal->extrapolated) : nullptr;
      }
    }
    for (const ordered_json* cell : run.cells)
      cells[static_cast<std::size_t>(cell - &measured[0])].update(columns);
  }
}

}  // namespace gatelight::apps
