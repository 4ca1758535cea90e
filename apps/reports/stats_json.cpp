#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "apps/reports/cache_statistics.h"
#include "apps/reports/recipe.h"
#include "apps/reports/run_report.h"
#include "apps/settings/parsing.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

/// Increases when a key changes its meaning or disappears.
constexpr int kSchema = 1;

ordered_json nonfinite(const renderer::RenderStatistics& statistics) {
  ordered_json samples = ordered_json::array();
  for (const renderer::NonFiniteSample& s : statistics.nonfinite_samples) {
    samples.push_back({{"x", s.x}, {"y", s.y}, {"sample", s.sample}, {"seed", s.seed}});
  }
  return {{"count", statistics.nonfinite}, {"samples", samples}};
}

ordered_json seconds(const RunReport& report, bool with_cache) {
  const renderer::RenderStatistics& s = report.statistics;
  const renderer::CacheStatistics& cache = s.cache;
  ordered_json json = {{"load", report.load_seconds}, {"build", s.build_seconds}};
  if (with_cache) json.update(cache_seconds_json(cache));
  json["render"] = s.render_seconds;
  if (s.resumed_seconds > 0.0) json["render_resumed"] = s.resumed_seconds;
  if (with_cache) {
    json["render_trace"] = cache.render_trace_seconds;
    json["render_query"] = cache.render_query_seconds;
  } else {
    json["render_trace"] = s.threads > 0 ? s.rays.seconds / s.threads : 0.0;
  }
  if (s.denoise_seconds > 0.0) json["denoise"] = s.denoise_seconds;
  if (s.cryptomatte_seconds > 0.0) json["cryptomatte"] = s.cryptomatte_seconds;
  json["write"] = report.write_seconds;
  json["total"] = report.total_seconds;
  return json;
}

}  // namespace

std::size_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

std::string stats_json(RenderSettings settings, const RunReport& report) {
  const renderer::RenderStatistics& s = report.statistics;
  renderer::use_device(settings.render, s.cache);
  const bool with_cache = renderer::uses_cache(settings.render.integrator);
  ordered_json json;
  json["schema"] = kSchema;
  json["version"] = version();
  json["command"] = report.command;
  json["scene"] = settings.scene;
  json["options"] = resolved_options(settings);
  json["outputs"] = settings.outputs;
  json["isa"] = s.isa;
  json["threads"] = s.threads;
  json.update(report.team_json);
  json["device"] = with_cache ? settings.render.cache.device : "cpu";
  json["width"] = s.width;
  json["height"] = s.height;
  json["spp"] = s.spp;
  json["samples"] = s.samples;
  json["interrupted"] = s.interrupted;
  json["ended_by"] = word_of(s.ended_by);
  if (s.estimated_error) json["estimated_error"] = *s.estimated_error;
  if (!s.denoiser.empty()) json["denoiser"] = s.denoiser;
  if (s.bounces_of_paths) json["bounces_of_paths"] = *s.bounces_of_paths;
  if (s.light_behind_walls) json["light_behind_walls"] = *s.light_behind_walls;
  json["exposure"] = report.exposure;
  if (report.signal != 0) json["signal"] = report.signal;
  json["seconds"] = seconds(report, with_cache);
  json["rays"] = {{"camera", s.rays.camera}, {"bounce", s.rays.bounce}, {"shadow", s.rays.shadow}};
  json["memory_bytes"] = {{"geometry", s.geometry_bytes},
                          {"bvh", s.bvh_bytes},
                          {"textures", s.texture_bytes},
                          {"lights", s.light_bytes}};
  if (with_cache) {
    json["memory_bytes"].update(cache_memory_json(s.cache));
    json["train"] = training_json(s.cache);
    json["cache"] = cache_json(s.cache);
  }
  json["memory_bytes"]["peak_rss"] = peak_resident_bytes();
  json["nonfinite"] = nonfinite(s);
  json["clamped"] = s.clamped;
  json["warnings"] = report.warnings;
  return json_text(json) + "\n";
}

}  // namespace gatelight::apps
