#include "apps/reports/cache_report_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "apps/reports/cache_statistics.h"
#include "apps/settings/render_settings.h"
#include "apps/terminal/text.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::CacheInstanceReport;
using renderer::CacheReport;
using renderer::CacheStatistics;

/// The JSON has all instances.
constexpr std::size_t kInstancesShown = 12;

std::string row(const std::string& name, const std::string& value) {
  return fmt::format("{:<14} {}\n", name, value);
}

std::string inputs_text(const CacheStatistics& s) {
  std::vector<std::string_view> names = {"features"};
  if (s.direction_input) names.push_back("direction of view");
  if (s.normal_input) names.push_back("normal");
  if (s.albedo_input) names.push_back("albedo");
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string instances_text(const std::vector<CacheInstanceReport>& instances) {
  std::vector<const CacheInstanceReport*> sorted;
  sorted.reserve(instances.size());
  for (const CacheInstanceReport& instance : instances) sorted.push_back(&instance);
  std::stable_sort(
      sorted.begin(), sorted.end(),
      [](const CacheInstanceReport* a, const CacheInstanceReport* b) { return a->nodes > b->nodes; });
  std::string text =
      fmt::format("\n{:>12} {:>12} {:>6} {:>10}  instance\n", "nodes", "triangles", "sides", "R");
  const auto add_line = [&](const CacheInstanceReport& line, const std::string& name) {
    text += fmt::format("{:>12} {:>12} {:>6} {:>10}  {}\n", format_integer(line.nodes),
                        format_integer(line.triangles), line.sides,
                        fmt::format("{}", fmt::join(line.resolutions, ",")), name);
  };
  CacheInstanceReport rest, total;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const CacheInstanceReport& instance = *sorted[i];
    for (CacheInstanceReport* sum : {&rest, &total}) {
      if (sum == &rest && i < kInstancesShown) continue;
      sum->nodes += instance.nodes;
      sum->triangles += instance.triangles;
      sum->sides += instance.sides;
    }
    if (i >= kInstancesShown) continue;
    add_line(instance, instance.name);
  }
  if (sorted.size() > kInstancesShown)
    add_line(rest, fmt::format("{} others", sorted.size() - kInstancesShown));
  add_line(total, fmt::format("all {}", sorted.size()));
  return text;
}

}  // namespace

std::string cache_report_text(const CacheReport& report, const renderer::RenderOptions& options) {
  const CacheStatistics& s = report.statistics;
  std::string text = "\n";
  text += row("cache", fmt::format("{}, {}, {} nodes", renderer::enum_name(options.integrator),
                                   renderer::enum_name(options.cache.encoding), format_integer(s.nodes)));
  text += row("cache memory",
              fmt::format("parameters {}, optimiser {}, layout {}; parameters without scouting {}",
                          format_bytes(s.parameter_bytes), format_bytes(s.optimizer_bytes),
                          format_bytes(s.layout_bytes), format_bytes(report.bytes_without_scouting)));
  text += row("network reads", inputs_text(s));
  text += row("sides stored", fmt::format("{} of {} possible", s.surfaces_stored, s.surfaces_possible));
  if (options.cache.encoding == neural::FeatureEncoding::gate) {
    text += row("node spacing", fmt::format("{:.4g} m", s.node_spacing));
    text += row("R of instances", histogram_text(s));
  }
  text += row("scouted in", fmt::format("{:.2f} s, set up in {:.2f} s", s.scout_seconds, s.setup_seconds));
  if (!report.instances.empty()) text += instances_text(report.instances);
  return text;
}

ordered_json cache_report_json(const CacheReport& report, const renderer::RenderOptions& options) {
  const CacheStatistics& s = report.statistics;
  ordered_json json = {{"integrator", renderer::enum_name(options.integrator)},
                       {"encoding", renderer::enum_name(options.cache.encoding)}};
  json["memory_bytes"] = cache_memory_json(s);
  json["memory_bytes"]["parameters_without_scouting"] = report.bytes_without_scouting;
  json["inputs"] = {{"direction", s.direction_input}, {"normal", s.normal_input}, {"albedo", s.albedo_input}};
  const ordered_json all = cache_json(s);
  for (const char* key : {"nodes", "surfaces_stored", "surfaces_possible", "resolution_histogram",
                          "node_spacing", "records_per_path"}) {
    json[key] = all[key];
  }
  json["seconds"] = {{"scout", s.scout_seconds}, {"setup", s.setup_seconds}};
  json["instances"] = ordered_json::array();
  for (const CacheInstanceReport& instance : report.instances) {
    json["instances"].push_back({{"name", instance.name},
                                 {"triangles", instance.triangles},
                                 {"resolutions", instance.resolutions},
                                 {"sides", instance.sides},
                                 {"nodes", instance.nodes}});
  }
  return json;
}

}  // namespace gatelight::apps
