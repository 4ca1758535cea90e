#pragma once
// Numbers and JSON as text.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::apps {

/// The number that a text begins with, with a point whatever the locale says; 0 for none.
double read_number(std::string_view text);

/// With the digits that a float has: 0.3, not 0.30000001192092896.
double shortest(float value);

std::string format_bytes(std::size_t bytes);  ///< "812 B", "1.50 MiB"
std::string format_count(double count);       ///< "950", "1.24 M"
std::string format_integer(std::uint64_t n);  ///< "1 240 273"
std::string format_duration(double seconds);  ///< "0:07", "1:02:07"

/// A file name need not be UTF-8; JSON must be: other bytes are replaced. indent -1: one line.
std::string json_text(const nlohmann::ordered_json& json, int indent = 1);

/// As a shell would have to be given it.
std::string quote_command(const std::vector<std::string>& command);

}  // namespace gatelight::apps
