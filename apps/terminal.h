#pragma once
// Lines on stderr for terminals and for programs.

#include <nlohmann/json_fwd.hpp>

namespace gatelight::apps {

int terminal_columns();

/// One line, at once.
void print_json_line(const nlohmann::ordered_json& object);

}  // namespace gatelight::apps
