#pragma once
// Messages on stderr. Only log.cpp includes spdlog, which is slow to compile.

#include <string>

namespace gatelight::apps {

/// quiet: errors only. verbose: details too. Otherwise errors and warnings.
void set_log_level(bool quiet, bool verbose);
void log_warning(const std::string& text);
/// Only with --verbose.
void log_detail(const std::string& text);

}  // namespace gatelight::apps
