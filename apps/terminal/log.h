#pragma once
// What the program says beside its results: to stderr. The library behind it is heavy to include and stays in
// log.cpp.

#include <cstdint>
#include <string>

namespace gatelight::apps {

enum class LogLevel : std::uint8_t { errors, warnings, details };

void set_log_level(LogLevel level);
void log_warning(const std::string& text);
/// Only with --verbose.
void log_detail(const std::string& text);

}  // namespace gatelight::apps
