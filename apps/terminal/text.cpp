#include "apps/terminal/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace gatelight::apps {

double read_number(std::string_view text) {
  double value = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

double shortest(float value) {
  return read_number(fmt::format("{}", value));
}

std::string format_bytes(std::size_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  constexpr std::array<const char*, 4> kUnits{"KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(bytes) / 1024.0;
  std::size_t unit = 0;
  // 1023.5 would be printed as 1024.
  while (value >= 1023.5 && unit + 1 < kUnits.size()) {
    value /= 1024.0;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", value, value < 10.0 ? 2 : value < 100.0 ? 1 : 0, kUnits[unit]);
}

std::string format_count(double count) {
  constexpr std::array<const char*, 4> kUnits{"", " k", " M", " G"};
  std::size_t unit = 0;
  while (count >= 999.5 && unit + 1 < kUnits.size()) {
    count /= 1000.0;
    ++unit;
  }
  const int digits = unit == 0 && count == std::floor(count) ? 0 : count < 10.0 ? 2 : count < 100.0 ? 1 : 0;
  return fmt::format("{:.{}f}{}", count, digits, kUnits[unit]);
}

std::string format_integer(std::uint64_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3;) {
    at -= 3;
    digits.insert(at, 1, ' ');
  }
  return digits;
}

std::string format_duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::llround(std::fmin(std::fmax(seconds, 0.0), 1e9)));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string format_percent(double fraction) {
  const double percent = 100.0 * fraction;
  return percent < 100.0 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string flag_text(const nlohmann::ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (!value.is_array()) return json_text(value, -1);
  std::vector<std::string> parts;
  for (const nlohmann::ordered_json& part : value) parts.push_back(flag_text(part));
  return fmt::format("{}", fmt::join(parts, ","));
}

std::string with_flags(std::string_view message) {
  constexpr const char* kName = "abcdefghijklmnopqrstuvwxyz0123456789-";
  std::string text;
  while (!message.empty()) {
    const std::size_t end = message.front() == '`' ? message.find_first_not_of(kName, 1) : 0;
    if (end != std::string_view::npos && end > 1 && message[end] == '`') {
      text += "--";
      text += message.substr(1, end - 1);
      message.remove_prefix(end + 1);
    } else {
      text += message.front();
      message.remove_prefix(1);
    }
  }
  return text;
}

std::string quote_command(const std::vector<std::string>& command) {
  constexpr const char* kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=./:,@%";
  std::string line;
  for (const std::string& word : command) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) {
      if (c == '\'') {
        line += "'\\''";
      } else {
        line += c;
      }
    }
    line += '\'';
  }
  return line;
}

}  // namespace gatelight::apps
