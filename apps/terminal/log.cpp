#include "apps/terminal/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace gatelight::apps {
namespace {

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = spdlog::stderr_color_mt("gatelight");
    made->set_pattern("%n: %^%l%$: %v");
    return made;
  }();
  return *instance;
}

}  // namespace

void set_log_level(bool quiet, bool verbose) {
  logger().set_level(quiet ? spdlog::level::err : verbose ? spdlog::level::info : spdlog::level::warn);
}

// The text is never a format string: file names may hold braces.
void log_warning(const std::string& text) {
  logger().warn("{}", text);
}

void log_detail(const std::string& text) {
  logger().info("{}", text);
}

}  // namespace gatelight::apps
