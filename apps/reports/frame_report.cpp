#include "apps/reports/frame_report.h"

#include <fmt/format.h>

#include "apps/terminal/text.h"

namespace gatelight::apps {

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
