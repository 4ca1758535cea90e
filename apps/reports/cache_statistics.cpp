#include "apps/reports/cache_statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "apps/settings/render_settings.h"
#include "apps/terminal/text.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::CacheInstanceReport;
using renderer::CacheReport;
using renderer::CacheStatistics;

ordered_json histogram_json(const CacheStatistics& s) {
  ordered_json json = ordered_json::object();
  for (std::size_t r = 0; r < s.resolution_histogram.size(); ++r) {
    if (s.resolution_histogram[r] > 0) json[std::to_string(r)] = s.resolution_histogram[r];
  }
  return json;
}

std::string training_text(const CacheStatistics& s) {
  std::string steps = format_integer(static_cast<std::uint64_t>(s.steps));
  if (s.steps != s.steps_wanted) steps += fmt::format(" of {}", s.steps_wanted);
  steps += s.steps_chosen ? " steps (chosen)" : " steps";
  if (s.steps == 0) return steps;
  return fmt::format("{}, {} records of {} paths, loss {:.3g}", steps,
                     format_count(static_cast<double>(s.records)),
                     format_count(static_cast<double>(s.training_paths)), s.loss);
}

/// "1: 20, 4: 3": instances by resolution.
std::string histogram_text(const CacheStatistics& s) {
  std::vector<std::string> parts;
  for (std::size_t r = 0; r < s.resolution_histogram.size(); ++r) {
    if (s.resolution_histogram[r] > 0) parts.push_back(fmt::format("{}: {}", r, s.resolution_histogram[r]));
  }
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

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

ordered_json training_json(const CacheStatistics& s) {
  ordered_json json = {{"steps", s.steps},
                       {"steps_wanted", s.steps_wanted},
                       {"steps_chosen", s.steps_chosen},
                       {"records", s.records},
                       {"loss", s.loss},
                       {"touched_nodes", s.touched_nodes},
                       {"rejected", s.rejected},
                       {"unstored", s.unstored},
                       {"paths", s.training_paths}};
  if (!s.diverged.empty()) json["diverged"] = s.diverged;
  return json;
}

ordered_json cache_json(const CacheStatistics& s) {
  ordered_json json = {{"backend", s.backend},
                       {"nodes", s.nodes},
                       {"surfaces_stored", s.surfaces_stored},
                       {"surfaces_possible", s.surfaces_possible},
                       {"resolution_histogram", histogram_json(s)},
                       {"node_spacing", s.node_spacing},
                       {"target_scale", s.target_scale},
                       {"records_per_path", s.records_per_path},
                       {"queries", s.queries},
                       {"negative_answers", s.negative_answers},
                       {"unstored_hits", s.unstored_hits}};
  if (s.trial) {
    json["trial"] = {{"device", s.trial->device},
                     {"cpu_seconds", s.trial->cpu_seconds},
                     {"device_seconds", s.trial->device_seconds}};
  }
  return json;
}

ordered_json cache_memory_json(const CacheStatistics& s) {
  return {{"parameters", s.parameter_bytes}, {"optimizer", s.optimizer_bytes}, {"layout", s.layout_bytes}};
}

ordered_json cache_seconds_json(const CacheStatistics& s) {
  return {{"scout", s.scout_seconds},
          {"setup", s.setup_seconds},
          {"train", s.train_seconds},
          {"train_trace", s.train_trace_seconds},
          {"train_query", s.train_query_seconds},
          {"train_step", s.train_step_seconds}};
}

std::string cache_summary(const CacheStatistics& s, const std::string& cache_in) {
  const bool loaded_only = !cache_in.empty() && s.steps == 0 && s.steps_wanted == 0;
  std::string text;
  if (!cache_in.empty()) text += fmt::format("loaded    the cache '{}'\n", cache_in);
  if (s.trial) {
    text +=
        fmt::format("device    {}, chosen because a step takes {:.2f} ms on the CPU and {:.2f} ms on {}\n",
                    s.device, 1e3 * s.trial->cpu_seconds, 1e3 * s.trial->device_seconds, s.trial->device);
  }
  if (!loaded_only) text += fmt::format("training  {}\n", training_text(s));
  text += fmt::format(
      "          scout {:.2f}, setup {:.2f}, train {:.2f} (trace {:.2f}, query {:.2f}, step {:.2f}) "
      "seconds\n",
      s.scout_seconds, s.setup_seconds, s.train_seconds, s.train_trace_seconds, s.train_query_seconds,
      s.train_step_seconds);
  text += fmt::format("answers   {}, {} clamped at zero; trace {:.2f}, query {:.2f} seconds\n",
                      format_count(static_cast<double>(s.queries)),
                      format_count(static_cast<double>(s.negative_answers)), s.render_trace_seconds,
                      s.render_query_seconds);
  text += fmt::format("cache     {} nodes on {} of {} sides: parameters {}, optimiser {}, layout {}\n",
                      format_integer(s.nodes), s.surfaces_stored, s.surfaces_possible,
                      format_bytes(s.parameter_bytes), format_bytes(s.optimizer_bytes),
                      format_bytes(s.layout_bytes));
  return text;
}

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
