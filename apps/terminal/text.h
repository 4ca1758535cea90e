#pragma once
// Numbers and JSON as text.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::apps {

/// The number at the begin of a text, with a decimal point in every locale; 0 where there is none.
double read_number(std::string_view text);

/// The double with the shortest digits of a float: 0.3, not 0.30000001192092896.
double shortest(float value);

std::string format_bytes(std::size_t bytes);  ///< "812 B", "1.50 MiB"
std::string format_count(double count);       ///< "950", "1.24 M"
std::string format_integer(std::uint64_t n);  ///< "1 240 273"
std::string format_duration(double seconds);  ///< "0:07", "1:02:07"
std::string format_percent(double fraction);  ///< "0.31 %", "3.1 %", "312 %"

/// JSON as text. Bytes that are not UTF-8, which file names may have, are replaced. indent -1: one line.
std::string json_text(const nlohmann::ordered_json& json, int indent = 1);

/// A value as its flag takes it: "960,540", "sobol", "0.5".
std::string flag_text(const nlohmann::ordered_json& value);

/// The libraries put names of options in back-ticks; the program shows its flags: `max-depth` becomes
/// --max-depth.
std::string with_flags(std::string_view message);

/// The command with the quotes that a shell needs.
std::string quote_command(const std::vector<std::string>& command);

}  // namespace gatelight::apps
