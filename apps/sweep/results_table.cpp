#include "apps/sweep/results_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/sweep/measured_runs.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

std::string scene_of(const MeasuredRun& run) {
  const auto size = run.cell().at("options").at("size").get<std::vector<int>>();
  return fmt::format("{}, {}", run.word("scene"), fmt::join(size, "x"));
}

void add(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Without the zero before the point.
std::string number(const std::optional<Mean>& mean, int digits) {
  if (!mean) return "-";
  const std::string text = fmt::format("{:.{}f}", mean->value, digits);
  return text.rfind("0.", 0) == 0 ? text.substr(1) : text;
}

std::string with_deviation(const std::optional<Mean>& mean, int digits) {
  if (!mean) return "";
  const std::string text = fmt::format("{:.{}f}", mean->value, digits);
  return mean->deviation ? fmt::format("{} ± {:.{}f}", text, *mean->deviation, digits) : text;
}

/// "1.6; 2.2*": by rel. MSE and FLIP. Empty where there is neither.
std::string times_faster(const MeasuredRun& run, Baseline baseline) {
  std::vector<std::string> texts;
  bool any = false;
  for (const char* error : kEqualErrors) {
    const std::string name = prefix_of(baseline) + std::string(error);
    const ordered_json& times = run.cell().at("times_faster").at(name);
    any |= times.is_number();
    const bool beyond = run.cell().at("extrapolated").at(name) == true;
    texts.push_back(times.is_number() ? fmt::format("{:.2g}{}", times.get<double>(), beyond ? "*" : "")
                                      : "-");
  }
  return any ? fmt::format("{}", fmt::join(texts, "; ")) : "";
}

/// A named run has its own name; others have the name of their series, and a number of steps or samples.
bool is_named(const MeasuredRun& run) {
  return run.cell().at("run") == run.cell().at("series");
}

std::string summary(const MeasuredRun& run) {
  const std::string times = times_faster(run, Baseline::denoised);
  return fmt::format("{:.1f} s, {}, {}{}", run.mean("seconds", "total")->value,
                     number(run.mean("errors", "rel_mse_clean"), 4), number(run.mean("errors", "flip"), 3),
                     times.empty() ? "" : fmt::format(" ({})", times));
}

std::string markdown(const TextTable& table) {
  std::string text;
  for (const std::string& name : table.head) text += name.empty() ? "| " : "| " + name + " ";
  text += "|\n|";
  for (std::size_t i = 0; i < table.head.size(); ++i) text += i < table.first_number ? "---|" : "---:|";
  text += "\n";
  for (const std::vector<std::string>& cells : table.rows)
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
  return text;
}

std::string noise(const ordered_json& results) {
  std::vector<std::string> noises;
  for (const ordered_json& scene : results.at("scenes")) {
    for (const ordered_json& reference : scene.value("references", ordered_json::array())) {
      const ordered_json& value = reference.at("rel_mse_noise");
      if (value.is_number())
        noises.push_back(fmt::format("{}, {}: {:.2g}", scene.at("name").get<std::string>(),
                                     reference.at("kind").get<std::string>(), value.get<double>()));
    }
  }
  return noises.empty()
             ? ""
             : fmt::format("\nNoise of the references in rel. MSE: {}.\n", fmt::join(noises, "; "));
}

}  // namespace

const char* const kTableLegend =
    R"(Seconds: all phases (scouting, training, rendering, denoising), without loading, building and writing. Rel. MSE: of one
picture, without the noise of the reference. bias²: the part that would remain with infinitely many samples, from pairs of
pictures. Means over the seeds, from three seeds on with standard deviations. Times faster: the seconds that the plain
integrator needs for the same error, as traced and denoised, over those of the run; * if that lies beyond the measured
sample counts. results.csv has all figures.)";

TextTable trade_table(const ordered_json& results) {
  const std::vector<MeasuredRun> runs = measured_runs(results.at("cells"));
  TextTable table;
  if (std::none_of(runs.begin(), runs.end(), is_named)) return table;
  std::vector<std::string> scenes, names;
  for (const Baseline baseline : {Baseline::denoised, Baseline::none}) {
    for (const MeasuredRun& run : runs) {
      if (run.baseline != baseline || (baseline == Baseline::none && !is_named(run))) continue;
      add(names, run.word("run"));
      add(scenes, scene_of(run));
    }
  }
  table.head = {""};
  table.head.insert(table.head.end(), names.begin(), names.end());
  table.first_number = table.head.size();
  for (const std::string& scene : scenes) {
    std::vector<std::string>& cells = table.rows.emplace_back(1, scene);
    for (const std::string& name : names) {
      const auto at = std::find_if(runs.begin(), runs.end(), [&](const MeasuredRun& run) {
        return scene_of(run) == scene && run.word("run") == name;
      });
      cells.push_back(at == runs.end() ? "" : summary(*at));
    }
  }
  return table;
}

TextTable runs_table(const ordered_json& results) {
  TextTable table = {{"", "", "seconds", "rel. MSE", "bias²", "FLIP",
                      "times faster than plain: rel. MSE; FLIP", "than plain denoised"},
                     2,
                     {}};
  std::string before;
  for (const MeasuredRun& run : measured_runs(results.at("cells"))) {
    const std::string scene = scene_of(run);
    table.rows.push_back(
        {scene == before ? "" : scene, run.word("run"), with_deviation(run.mean("seconds", "total"), 1),
         with_deviation(run.mean("errors", "rel_mse_clean"), 4),
         with_deviation(run.mean("errors", "bias_rel_mse"), 4), with_deviation(run.mean("errors", "flip"), 3),
         times_faster(run, Baseline::traced), times_faster(run, Baseline::denoised)});
    before = scene;
  }
  return table;
}

std::string results_table(const ordered_json& results) {
  const TextTable trade = trade_table(results);
  return (trade.rows.empty() ? "" : markdown(trade) + "\n") + kTableLegend + "\n\n" +
         markdown(runs_table(results)) + noise(results);
}

}  // namespace gatelight::apps
