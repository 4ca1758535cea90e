#pragma once
// Parses values of the command line and of files. Each function throws BadOption, whose parts are
// the option, the text and what was expected.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/settings/enum_names.h"

namespace gatelight::apps {

struct IntegerRange {
  std::int64_t min = 0;
  std::int64_t max = std::numeric_limits<std::int64_t>::max();
};

/// NaN is in no range, infinity only where `infinity` is set.
struct RealRange {
  double min = 0.0;
  double max = std::numeric_limits<double>::max();
  bool excludes_min = false;
  bool excludes_max = false;
  bool infinity = false;
};

/// Any number that a float can hold.
inline constexpr RealRange kAnyFloat{-3.4e38, 3.4e38};
inline constexpr RealRange kPositive{.min = 0.0, .max = 3.4e38, .excludes_min = true};

std::int64_t parse_integer(const std::string& option, const std::string& text, const IntegerRange& range);
double parse_real(const std::string& option, const std::string& text, const RealRange& range);
/// The value rounded to single precision must be in the range too, and must not vanish.
float parse_float(const std::string& option, const std::string& text, const RealRange& range);
std::array<float, 3> parse_triple(const std::string& option, const std::string& text, const RealRange& range);
/// "WxH", each from 1 to 65536.
std::array<int, 2> parse_size(const std::string& option, const std::string& text);
/// "x0,y0,x1,y1", with x0 < x1 and y0 < y1.
std::array<int, 4> parse_region(const std::string& option, const std::string& text);

/// Without spaces at both ends.
std::string trimmed(const std::string& text);
/// The parts between the separators: one more than there are separators.
std::vector<std::string> split(std::string_view text, char separator);
/// "a,b,c". Empty words are refused.
std::vector<std::string> split_list(const std::string& option, const std::string& text);

/// Whether the text is three numbers rather than the name of a file.
bool looks_like_triple(const std::string& text);

std::string join_names(std::span<const std::string_view> names);
[[noreturn]] void refuse_choice(const std::string& option, const std::string& text, const std::string& names);

template <typename Table>
std::string choice_names(const Table& table) {
  std::vector<std::string_view> names;
  for (const auto& choice : table) names.push_back(choice.name);
  return join_names(names);
}

template <typename Table>
auto parse_choice(const std::string& option, const std::string& text, const Table& table) {
  for (const auto& choice : table) {
    if (choice.name == text) return choice.value;
  }
  refuse_choice(option, text, choice_names(table));
}

}  // namespace gatelight::apps
