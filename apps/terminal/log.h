#pragma once
// Messages on stderr, as text or as JSON lines.

#include <string>

namespace gatelight::apps {

/// quiet: errors only. verbose: details too. Otherwise errors and warnings.
void set_log_level(bool quiet, bool verbose);

/// With --progress json every message is an event: an object in a line of its own. This applies to the last
/// line of errors.h too.
void set_json_messages(bool on);
bool json_messages();

void log_warning(const std::string& text);
/// Only with --verbose.
void log_detail(const std::string& text);

}  // namespace gatelight::apps
