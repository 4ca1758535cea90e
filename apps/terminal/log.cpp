#include "apps/terminal/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

std::atomic<bool> as_json{false};

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = spdlog::stderr_color_mt("gatelight");
    made->set_pattern("%n: %^%l%$: %v");
    return made;
  }();
  return *instance;
}

void log(spdlog::level::level_enum level, const char* event, const std::string& text) {
  if (!json_messages()) {
    // The text is never a format string: file names may hold braces.
    logger().log(level, "{}", text);
  } else if (logger().should_log(level)) {
    print_json_line({{"event", event}, {"message", text}});
  }
}

}  // namespace

void set_log_level(bool quiet, bool verbose) {
  logger().set_level(quiet ? spdlog::level::err : verbose ? spdlog::level::info : spdlog::level::warn);
}

void set_json_messages(bool on) {
  as_json.store(on);
}

bool json_messages() {
  return as_json.load();
}

void log_warning(const std::string& text) {
  log(spdlog::level::warn, "warning", with_flags(text));
}

void log_detail(const std::string& text) {
  log(spdlog::level::info, "detail", text);
}

}  // namespace gatelight::apps
