#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/reports/cache_statistics.h"
#include "apps/reports/run_report.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

double per_second(double count, double seconds) {
  return seconds > 0.0 ? count / seconds : 0.0;
}

/// Whether a signal, not --train-time, ended training. Such a cache is not written to --cache-out.
bool training_cut_short(const renderer::CacheOptions& options, const renderer::CacheStatistics& s) {
  const bool out_of_time = options.train_seconds > 0.0 && s.train_seconds >= options.train_seconds;
  return s.steps < s.steps_wanted && !out_of_time;
}

}  // namespace

std::string summary(const RenderSettings& settings, const RunReport& report) {
  using renderer::EndedBy;
  const renderer::RenderStatistics& s = report.statistics;
  const double samples = static_cast<double>(s.samples);
  const double rays = static_cast<double>(s.rays.camera + s.rays.bounce + s.rays.shadow);
  std::string text = fmt::format("written   {}\n", fmt::join(settings.outputs, ", "));
  const std::string reconstruct =
      settings.render.reconstruct ? fmt::format(", reconstruct {:.2f}", s.reconstruct_seconds) : "";
  text += fmt::format("seconds   load {:.2f}, build {:.2f}, render {:.2f}{}, write {:.2f}, total {:.2f}\n",
                      report.load_seconds, s.build_seconds, s.render_seconds, reconstruct,
                      report.write_seconds, report.total_seconds);
  std::string error;
  if (s.estimated_error) {
    error = fmt::format("; estimated error {}", format_percent(*s.estimated_error));
    if (renderer::uses_cache(settings.render.integrator)) error += " beside the cache's bias";
  }
  if (settings.render.max_error > 0.0 && (s.ended_by == EndedBy::spp || s.ended_by == EndedBy::time_limit)) {
    error += fmt::format(", not {}: {} ended it first", format_percent(settings.render.max_error),
                         s.ended_by == EndedBy::spp ? "--spp" : "--time-limit");
  }
  constexpr double kToldLoss = 0.001;
  if (s.lost_light >= kToldLoss)
    error += fmt::format("; lost with fireflies {} of the light", format_percent(s.lost_light));
  text += fmt::format("samples   {} at {} spp, {:.3f} million/s on {} thread{}{}\n",
                      format_integer(s.samples), s.spp, per_second(samples, s.render_seconds) * 1e-6,
                      s.threads, s.threads == 1 ? "" : "s", error);
  text += fmt::format("rays      {}, {:.2f} million/s\n", format_count(rays),
                      per_second(rays, s.render_seconds) * 1e-6);
  if (!settings.exposure) {
    text += fmt::format("exposure  {:.1f} EV by the picture's light; --exposure {:.1f} keeps it\n",
                        report.exposure, report.exposure);
  }
  text += fmt::format("memory    peak {}: geometry {}, BVH {}, textures {}\n",
                      format_bytes(peak_resident_bytes()), format_bytes(s.geometry_bytes),
                      format_bytes(s.bvh_bytes), format_bytes(s.texture_bytes));
  if (renderer::uses_cache(settings.render.integrator)) text += cache_summary(s.cache);
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
  if (!o.checkpoint.file.empty()) text += "; --resume goes on with it";
  return text;
}

}  // namespace gatelight::apps
