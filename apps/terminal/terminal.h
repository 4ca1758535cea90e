#pragma once
// Lines on stderr for terminals and for programs.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace gatelight::apps {

int terminal_columns();

/// To stderr. What cannot be said (a full disk, a pipe whose reader is gone) is no reason to end.
void tell(std::string_view text);

/// One line, at once.
void print_json_line(const nlohmann::ordered_json& object);

}  // namespace gatelight::apps
