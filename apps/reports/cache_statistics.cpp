#include "apps/reports/cache_statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
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
  return {{"backend", s.backend},
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

std::string histogram_text(const CacheStatistics& s) {
  std::vector<std::string> parts;
  for (std::size_t r = 0; r < s.resolution_histogram.size(); ++r) {
    if (s.resolution_histogram[r] > 0) parts.push_back(fmt::format("{}: {}", r, s.resolution_histogram[r]));
  }
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace gatelight::apps
