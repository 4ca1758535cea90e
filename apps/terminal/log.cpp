#include "apps/terminal/log.h"

#include <fmt/format.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"

namespace gatelight::apps {
namespace {

std::atomic<bool> as_json{false}, shows_warnings{true}, shows_details{false};

void print(const char* event, const char* word, const std::string& text) {
  if (json_messages()) {
    print_json_line({{"event", event}, {"message", text}});
  } else {
    print_status(fmt::format("gatelight: {}: {}\n", word, text));
  }
}

}  // namespace

void set_log_level(bool quiet, bool verbose) {
  shows_warnings = !quiet;
  shows_details = verbose && !quiet;
}

void set_json_messages(bool on) {
  as_json.store(on);
}

bool json_messages() {
  return as_json.load();
}

void log_warning(const std::string& text) {
  if (shows_warnings) print("warning", "warning", with_flags(text));
}

void log_detail(const std::string& text) {
  if (shows_details) print("detail", "info", text);
}

}  // namespace gatelight::apps
