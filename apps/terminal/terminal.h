#pragma once
// Output of the program: lines on stderr, results on stdout.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace gatelight::apps {

int terminal_columns();

/// silent: from now on nothing is written to stderr and stdout, because another process prints.
void set_silent(bool silent);

/// Writes to stderr. Write errors (a full disk, a pipe without a reader) are ignored.
void print_status(std::string_view text);

/// Writes the object as one line to stderr and flushes it.
void print_json_line(const nlohmann::ordered_json& object);

/// Writes a result to stdout. Throws OutputError, for a closed or full stdout and a pipe without a reader.
void write_stdout(std::string_view bytes);

/// Writes a result. `target` is a file or "-" for stdout. Throws OutputError.
void write_text(const std::string& target, const std::string& text);

}  // namespace gatelight::apps
