#pragma once
// What the program prints: lines on stderr, results on stdout.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace gatelight::apps {

int terminal_columns();

/// To stderr. What cannot be said (a full disk, a pipe whose reader is gone) is no reason to end.
void tell(std::string_view text);

/// One line, at once.
void print_json_line(const nlohmann::ordered_json& object);

/// A result. `target` is a file or "-" for stdout. Throws renderer::OutputError, for a closed or full stdout
/// too.
void write_text(const std::string& target, const std::string& text);

}  // namespace gatelight::apps
