#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/reports/cache_statistics.h"
#include "apps/reports/run_report.h"
#include "apps/settings/parsing.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

constexpr renderer::Choice<renderer::EndedBy> kEnds[] = {{"spp", renderer::EndedBy::spp},
                                                         {"max-error", renderer::EndedBy::max_error},
                                                         {"time-limit", renderer::EndedBy::time_limit},
                                                         {"signal", renderer::EndedBy::caller},
                                                         {"device", renderer::EndedBy::device}};

double per_second(double count, double seconds) {
  return seconds > 0.0 ? count / seconds : 0.0;
}

/// Whether a signal, not --train-time, ended training. Such a cache is not written to --cache-out.
bool training_cut_short(const renderer::CacheOptions& options, const renderer::CacheStatistics& s) {
  const bool out_of_time = options.train_seconds > 0.0 && s.train_seconds >= options.train_seconds;
  return s.steps < s.steps_wanted && !out_of_time;
}

std::uint64_t count_rays(const renderer::RayCounts& rays) {
  return rays.camera + rays.bounce + rays.shadow;
}

/// Seconds in which the picture's samples were traced: paths of training may be such samples.
double sample_seconds(const renderer::RenderOptions& options, const renderer::RenderStatistics& s) {
  const bool taught =
      renderer::uses_cache(options.integrator) && options.cache.source == renderer::TrainingSource::picture;
  return s.render_seconds + (taught ? s.cache.train_trace_seconds : 0.0);
}

/// Seconds in which all rays were traced, those of scouting and training too.
double ray_seconds(const renderer::RenderStatistics& s) {
  return s.render_seconds + s.cache.scout_seconds + s.cache.train_trace_seconds;
}

/// Render time of the whole picture: samples, rays and this time are sums over the runs that --resume joins.
std::string render_seconds_text(const renderer::RenderStatistics& s) {
  if (s.resumed_seconds <= 0.0) return fmt::format("render {:.2f}", s.render_seconds);
  return fmt::format("render {:.2f} ({:.2f} of them before --resume)", s.render_seconds, s.resumed_seconds);
}

}  // namespace

std::string word_of(renderer::EndedBy end) {
  return renderer::name_of(kEnds, end);
}

nlohmann::ordered_json summary_json(const RenderSettings& settings, const RunReport& report) {
  const renderer::RenderStatistics& s = report.statistics;
  nlohmann::ordered_json json = {
      {"outputs", settings.outputs},
      {"seconds", report.total_seconds},
      {"spp", s.spp},
      {"samples", s.samples},
      {"samples_per_second", per_second(static_cast<double>(s.samples), sample_seconds(settings.render, s))},
      {"rays", count_rays(s.rays)},
      {"render_seconds", s.render_seconds},
      {"ended_by", word_of(s.ended_by)},
      {"exposure", report.exposure},
      {"peak_memory_bytes", peak_resident_bytes()}};
  if (s.estimated_error) json["estimated_error"] = *s.estimated_error;
  if (renderer::uses_cache(settings.render.integrator)) json["train_steps"] = s.cache.steps;
  return json;
}

std::string summary(const RenderSettings& settings, const RunReport& report) {
  using renderer::EndedBy;
  const renderer::RenderStatistics& s = report.statistics;
  const double samples = static_cast<double>(s.samples);
  const double rays = static_cast<double>(count_rays(s.rays));
  std::string text = fmt::format("written   {}\n", fmt::join(settings.outputs, ", "));
  const std::string denoise =
      s.denoise_seconds > 0.0 ? fmt::format(", denoise {:.2f}", s.denoise_seconds) : "";
  const std::string cryptomatte =
      s.cryptomatte_seconds > 0.0 ? fmt::format("cryptomatte {:.2f}, ", s.cryptomatte_seconds) : "";
  text += fmt::format("seconds   load {:.2f}, build {:.2f}, {}{}{}, write {:.2f}, total {:.2f}\n",
                      report.load_seconds, s.build_seconds, cryptomatte, render_seconds_text(s), denoise,
                      report.write_seconds, report.total_seconds);
  std::string error;
  if (s.estimated_error) {
    error = fmt::format("; estimated error {}", format_percent(*s.estimated_error));
    if (renderer::uses_cache(settings.render.integrator)) error += " without the cache's bias";
  }
  if (settings.render.max_error > 0.0 && (s.ended_by == EndedBy::spp || s.ended_by == EndedBy::time_limit)) {
    error += fmt::format(", not {}: {} ended it first", format_percent(settings.render.max_error),
                         s.ended_by == EndedBy::spp ? "--spp" : "--time-limit");
  }
  text +=
      fmt::format("samples   {} at {} spp, {:.3f} million/s on {} thread{}{}\n", format_integer(s.samples),
                  s.spp, per_second(samples, sample_seconds(settings.render, s)) * 1e-6, s.threads,
                  s.threads == 1 ? "" : "s", error);
  text += fmt::format("rays      {}, {:.2f} million/s\n", format_count(rays),
                      per_second(rays, ray_seconds(s)) * 1e-6);
  if (s.bounces_of_paths) {
    const std::string steps =
        s.steps_in_media > 0.05 ? fmt::format(" and {:.1f} steps in media", s.steps_in_media) : "";
    text += fmt::format(
        "integrator {}, chosen because light paths have {:.1f} bounces{}; --integrator {} {}\n",
        enum_name(settings.render.integrator), *s.bounces_of_paths, steps,
        renderer::uses_cache(settings.render.integrator) ? "path" : "nrc",
        renderer::uses_cache(settings.render.integrator) ? "renders without a cache" : "uses a cache");
  }
  if (s.light_behind_walls) {
    text += fmt::format("watertight {}, chosen because without shadows there is {:.3g} times the light\n",
                        enum_name(settings.render.watertight), *s.light_behind_walls);
  }
  if (!s.denoiser.empty()) text += fmt::format("denoiser  {}\n", s.denoiser);
  text += report.team_summary;
  if (!settings.exposure) {
    text +=
        fmt::format("exposure  {:.1f} EV, from the picture's brightness; --exposure {:.1f} sets the same\n",
                    report.exposure, report.exposure);
  }
  text += fmt::format("memory    peak {}: geometry {}, BVH {}, textures {}\n",
                      format_bytes(peak_resident_bytes()), format_bytes(s.geometry_bytes),
                      format_bytes(s.bvh_bytes), format_bytes(s.texture_bytes));
  if (renderer::uses_cache(settings.render.integrator))
    text += cache_summary(s.cache, settings.render.cache.cache_in);
  return text;
}

std::string stop_notice(const RenderSettings& settings, const RunReport& report) {
  const renderer::RenderStatistics& s = report.statistics;
  const renderer::RenderOptions& o = settings.render;
  const bool in_training = renderer::uses_cache(o.integrator) && training_cut_short(o.cache, s.cache);
  std::string text = fmt::format("stopped by signal {} after ", report.signal);
  if (in_training) text += fmt::format("{} of {} training steps and ", s.cache.steps, s.cache.steps_wanted);
  text += fmt::format("{} of {} samples per pixel; the picture so far is in '{}'", s.spp, o.spp,
                      settings.outputs.front());
  if (in_training && !o.cache.cache_out.empty()) {
    text += fmt::format("; the cache '{}' was not written", o.cache.cache_out);
  }
  if (!o.checkpoint.file.empty()) text += "; --resume continues with it";
  return text;
}

std::string frame_line(int frame, const RenderSettings& settings, const RunReport& report) {
  const renderer::RenderStatistics& s = report.statistics;
  std::string text = fmt::format("frame {:<6} {:.2f} s, {} spp", frame, report.total_seconds, s.spp);
  if (renderer::uses_cache(settings.render.integrator)) {
    text += fmt::format(", {} training steps", s.cache.steps);
    if (s.cache.light_change > 0.0)
      text += fmt::format(" (light changed by {})", format_percent(s.cache.light_change));
  }
  if (s.reused > 0.0) text += fmt::format(", {} reused", format_percent(s.reused));
  return text + fmt::format("; {}\n", settings.outputs.front());
}

std::string frames_summary(std::size_t frames, double seconds, const RunReport& report) {
  std::string text =
      fmt::format("frames    {} in {:.1f} s, {:.2f} s each; load {:.2f}\n", frames, seconds,
                  frames > 0 ? seconds / static_cast<double>(frames) : 0.0, report.load_seconds);
  return text + fmt::format("memory    peak {}\n", format_bytes(peak_resident_bytes()));
}

}  // namespace gatelight::apps
