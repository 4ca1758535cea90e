#include "apps/render/console.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/settings/complete_settings.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {

Console::Console(const RenderSettings& settings)
    : progress(settings.quiet ? ProgressMode::none : settings.progress,
               static_cast<double>(count_pixels(settings.render))),
      quiet_(settings.quiet),
      json_(settings.progress == ProgressMode::json) {}

void Console::warn(const std::string& text) {
  report.warnings.push_back(with_flags(text));
  if (!printed_.insert(text).second) return;
  progress.clear();
  log_warning(text);
}

void Console::warn(const std::vector<std::string>& texts) {
  for (const std::string& text : texts) warn(text);
}

void Console::note(const char* about, const std::string& text) {
  if (quiet_) return;
  progress.clear();
  if (json_) {
    print_json_line({{"event", "note"}, {"about", about}, {"message", text}});
  } else {
    print_status(fmt::format("{:<9} {}\n", about, text));
  }
}

void Console::note_skipped(std::size_t skipped, std::size_t count) {
  note("skipped",
       fmt::format("{} of {}, which already {}", skipped, count, skipped == 1 ? "exists" : "exist"));
}

int Console::note_signal(int signal, const std::string& text) {
  progress.clear();
  print_notice(fmt::format("stopped by signal {} {}", signal, text), kSignalBase + signal);
  return kSignalBase + signal;
}

}  // namespace gatelight::apps
