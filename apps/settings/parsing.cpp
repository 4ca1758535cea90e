#include "apps/settings/parsing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/nearest_word.h"
#include "base/to_number.h"

namespace gatelight::apps {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& expected) {
  throw BadOption({option, text, "", expected});
}

bool inside(double value, const RealRange& range) {
  if (std::isnan(value)) return false;
  if (std::isinf(value)) return range.infinity && value > 0.0;
  if (range.excludes_min ? value <= range.min : value < range.min) return false;
  return range.excludes_max ? value < range.max : value <= range.max;
}

constexpr double kMinFloat = std::numeric_limits<float>::min();

/// Smaller values are flushed to zero wherever they are used.
bool vanishes(double value) {
  return value != 0.0 && std::abs(value) < kMinFloat;
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

/// `size` numbers with separators between them, or nothing.
template <typename Number, std::size_t size>
std::optional<std::array<Number, size>> read_numbers(std::string_view text, char separator) {
  const std::vector<std::string> parts = split(text, separator);
  std::array<Number, size> numbers{};
  if (parts.size() != size) return std::nullopt;
  for (std::size_t i = 0; i < size; ++i) {
    const std::optional<Number> number = to_number<Number>(parts[i]);
    if (!number) return std::nullopt;
    numbers[i] = *number;
  }
  return numbers;
}

}  // namespace

std::int64_t parse_integer(const std::string& option, const std::string& text, const IntegerRange& range) {
  const std::optional<std::int64_t> value = to_number<std::int64_t>(text);
  if (!value || *value < range.min || *value > range.max) refuse(option, text, describe(range));
  return *value;
}

double parse_real(const std::string& option, const std::string& text, const RealRange& range) {
  const std::optional<double> value = to_number<double>(text);
  if (!value || !inside(*value, range)) refuse(option, text, describe(range));
  return *value;
}

float parse_float(const std::string& option, const std::string& text, const RealRange& range) {
  const double value = parse_real(option, text, range);
  const float rounded = static_cast<float>(value);
  if (!inside(static_cast<double>(rounded), range)) refuse(option, text, describe(range));
  if (vanishes(value)) {
    refuse(option, text, fmt::format("a number of single precision: 0, or of at least {:.3g}", kMinFloat));
  }
  return rounded;
}

std::array<float, 3> parse_triple(const std::string& option, const std::string& text,
                                  const RealRange& range) {
  const auto values = read_numbers<double, 3>(text, ',');
  if (!values || !std::all_of(values->begin(), values->end(), [&](double x) { return inside(x, range); }))
    refuse(option, text, fmt::format("three numbers a,b,c, each {}", describe(range)));
  const auto& [a, b, c] = *values;
  return {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
}

std::array<int, 2> parse_size(const std::string& option, const std::string& text) {
  const auto size = read_numbers<int, 2>(text, 'x');
  if (!size || !std::all_of(size->begin(), size->end(), [](int n) { return n >= 1 && n <= 65536; }))
    refuse(option, text, "a size WxH in pixels, each from 1 to 65536, such as 960x540");
  return *size;
}

std::array<int, 4> parse_region(const std::string& option, const std::string& text) {
  const auto region = read_numbers<int, 4>(text, ',').value_or(std::array<int, 4>{});
  const auto& [x0, y0, x1, y1] = region;
  if (x0 < 0 || y0 < 0 || x0 >= x1 || y0 >= y1) {
    refuse(option, text,
           "a region x0,y0,x1,y1 in pixels with 0 <= x0 < x1 and 0 <= y0 < y1 (x1, y1 excluded)");
  }
  return region;
}

std::string trimmed(const std::string& text) {
  constexpr const char* kSpaces = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpaces);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(kSpaces) - begin + 1);
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t at = text.find(separator);
    parts.emplace_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::vector<std::string> split_list(const std::string& option, const std::string& text) {
  std::vector<std::string> words = split(text, ',');
  for (const std::string& word : words) {
    if (word.empty()) refuse(option, text, "a list of words separated by commas");
  }
  return words;
}

bool looks_like_triple(const std::string& text) {
  return read_numbers<double, 3>(text, ',').has_value();
}

std::string join_names(std::span<const std::string_view> names) {
  return fmt::format("{}", fmt::join(names.begin(), names.end(), "|"));
}

void refuse_choice(const std::string& option, const std::string& text, const std::string& names) {
  throw BadOption({option, text, "", "one of " + names, did_you_mean(text, split(names, '|'))});
}

}  // namespace gatelight::apps
