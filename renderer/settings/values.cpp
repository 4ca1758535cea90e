#include "renderer/settings/values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "renderer/machine/errors.h"

namespace gatelight::renderer {
namespace {

template <typename Number>
std::optional<Number> read_number(std::string_view text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

[[noreturn]] void refuse(const std::string& flag, const std::string& text, const std::string& expected) {
  throw BadOption(fmt::format("{}: '{}' is not {}", flag, text, expected));
}

bool inside(double value, const RealRange& range) {
  if (std::isnan(value)) return false;
  if (std::isinf(value)) return range.infinity && value > 0.0;
  if (range.excludes_min ? value <= range.min : value < range.min) return false;
  return range.excludes_max ? value < range.max : value <= range.max;
}

constexpr double kLeastFloat = std::numeric_limits<float>::min();

/// Smaller ones are flushed to zero wherever they are used.
bool vanishes(double value) {
  return value != 0.0 && std::abs(value) < kLeastFloat;
}

std::string describe(const IntegerRange& range) {
  return fmt::format("an integer from {} to {}", range.min, range.max);
}

std::string describe(const RealRange& range) {
  const bool below_open = range.min <= kAnyFloat.min;
  const bool above_open = range.max >= kAnyFloat.max;
  std::string text = "a finite number";
  if (!below_open) {
    text = fmt::format("a number {} {}", range.excludes_min ? "above" : "of at least", range.min);
  }
  if (!above_open) {
    text += fmt::format("{} {} {}", below_open ? "" : " and", range.excludes_max ? "below" : "at most",
                        range.max);
  }
  return range.infinity ? text + ", or inf" : text;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

}  // namespace

std::int64_t parse_integer(const std::string& flag, const std::string& text, const IntegerRange& range) {
  const std::optional<std::int64_t> value = read_number<std::int64_t>(text);
  if (!value || *value < range.min || *value > range.max) refuse(flag, text, describe(range));
  return *value;
}

double parse_real(const std::string& flag, const std::string& text, const RealRange& range) {
  const std::optional<double> value = read_number<double>(text);
  if (!value || !inside(*value, range)) refuse(flag, text, describe(range));
  return *value;
}

float parse_float(const std::string& flag, const std::string& text, const RealRange& range) {
  const double value = parse_real(flag, text, range);
  const float rounded = static_cast<float>(value);
  if (!inside(static_cast<double>(rounded), range)) refuse(flag, text, describe(range));
  if (vanishes(value)) {
    refuse(flag, text, fmt::format("a number of single precision: 0, or of at least {:.3g}", kLeastFloat));
  }
  return rounded;
}

std::array<float, 3> parse_triple(const std::string& flag, const std::string& text, const RealRange& range) {
  const std::vector<std::string_view> parts = split(text, ',');
  std::array<float, 3> values{};
  bool good = parts.size() == values.size();
  for (std::size_t i = 0; good && i < values.size(); ++i) {
    const std::optional<double> value = read_number<double>(parts[i]);
    good = value && inside(*value, range);
    if (good) values[i] = static_cast<float>(*value);
  }
  if (!good) refuse(flag, text, fmt::format("three numbers a,b,c, each {}", describe(range)));
  return values;
}

std::array<int, 2> parse_size(const std::string& flag, const std::string& text) {
  const std::vector<std::string_view> parts = split(text, 'x');
  if (parts.size() == 2) {
    const std::optional<int> width = read_number<int>(parts[0]);
    const std::optional<int> height = read_number<int>(parts[1]);
    const auto good = [](const std::optional<int>& n) { return n && *n >= 1 && *n <= 65536; };
    if (good(width) && good(height)) return {*width, *height};
  }
  refuse(flag, text, "a size WxH in pixels, each from 1 to 65536, such as 960x540");
}

std::array<int, 4> parse_region(const std::string& flag, const std::string& text) {
  const std::vector<std::string_view> parts = split(text, ',');
  std::array<int, 4> region{};
  bool good = parts.size() == region.size();
  for (std::size_t i = 0; good && i < region.size(); ++i) {
    const std::optional<int> value = read_number<int>(parts[i]);
    good = value && *value >= 0;
    if (good) region[i] = *value;
  }
  if (!good || region[0] >= region[2] || region[1] >= region[3]) {
    refuse(flag, text, "a region x0,y0,x1,y1 in pixels with 0 <= x0 < x1 and 0 <= y0 < y1 (x1, y1 excluded)");
  }
  return region;
}

std::vector<std::string> split_list(const std::string& flag, const std::string& text) {
  std::vector<std::string> words;
  for (const std::string_view part : split(text, ',')) {
    if (part.empty()) refuse(flag, text, "a list of words separated by commas");
    words.emplace_back(part);
  }
  return words;
}

bool looks_like_triple(const std::string& text) {
  const std::vector<std::string_view> parts = split(text, ',');
  return parts.size() == 3 && std::all_of(parts.begin(), parts.end(), [](std::string_view part) {
           return read_number<double>(part).has_value();
         });
}

std::string join_names(std::span<const std::string_view> names) {
  return fmt::format("{}", fmt::join(names.begin(), names.end(), "|"));
}

void refuse_choice(const std::string& flag, const std::string& text, const std::string& names) {
  refuse(flag, text, "one of " + names);
}

}  // namespace gatelight::renderer
