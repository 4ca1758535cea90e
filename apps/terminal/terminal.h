#pragma once
// What the program prints: lines on stderr, results on stdout.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace gatelight::apps {

int terminal_columns();

/// Nothing is written to the terminal from now on: neither to stderr nor to stdout. Other ranks speak.
void set_silent(bool silent);

/// Writes to stderr. Write errors (a full disk, a pipe without a reader) are ignored.
void tell(std::string_view text);

/// Writes the object as one line to stderr and flushes it.
void print_json_line(const nlohmann::ordered_json& object);

/// Writes a result. `target` is a file or "-" for stdout. Throws renderer::OutputError, for a closed or full
/// stdout too.
void write_text(const std::string& target, const std::string& text);

}  // namespace gatelight::apps
