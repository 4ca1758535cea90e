#pragma once
// What the program says beside its results: to stderr. The library behind it is heavy to include and stays in
// log.cpp.

#include <string>

namespace gatelight::apps {

/// Errors alone where quiet, details too where verbose, else errors and warnings.
void set_log_level(bool quiet, bool verbose);
void log_warning(const std::string& text);
/// Only with --verbose.
void log_detail(const std::string& text);

}  // namespace gatelight::apps
