#include "apps/manual/values.h"

#include <algorithm>
#include <cctype>

namespace gatelight::apps {
namespace {

bool is_lower_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

/// "a|b[:C|D]" at the bars outside of brackets.
std::vector<std::string_view> alternatives(std::string_view unit) {
  std::vector<std::string_view> parts;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t at = 0; at <= unit.size(); ++at) {
    if (at < unit.size() && unit[at] == '[') ++depth;
    if (at < unit.size() && unit[at] == ']') --depth;
    if (at < unit.size() && (unit[at] != '|' || depth > 0)) continue;
    parts.push_back(unit.substr(begin, at - begin));
    begin = at + 1;
  }
  return parts;
}

/// The part of an alternative that is typed as it stands: "auto", "fixed:" of "fixed:R"; empty for "r,g,b".
std::string literal(std::string_view part) {
  std::size_t end = 0;
  const auto is_part = [](char c) { return is_lower_or_digit(c) || c == '-' || c == '_'; };
  while (end < part.size() && is_part(part[end])) ++end;
  if (end == 0 || part[0] == '-') return "";
  if (end == part.size() || part[end] == '[') return std::string(part.substr(0, end));
  const bool goes_on = part[end] == ':' || part[end] == '/';
  return goes_on ? std::string(part.substr(0, end + 1)) : "";
}

/// Those that a text names: ".exr, .png".
std::vector<std::string> extensions_in(std::string_view text) {
  std::vector<std::string> extensions;
  for (std::size_t at = text.find('.'); at != std::string_view::npos; at = text.find('.', at + 1)) {
    std::size_t end = at + 1;
    while (end < text.size() && is_lower_or_digit(text[end])) ++end;
    const bool begins = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    if (begins && end > at + 2) extensions.emplace_back(text.substr(at + 1, end - at - 1));
  }
  return extensions;
}

}  // namespace

Values values_of(const Option& option) {
  Values values;
  for (const std::string_view part : alternatives(option.names)) {
    if (!part.empty()) values.words.emplace_back(part);
  }
  values.is_list =
      !values.words.empty() && (option.unit == "LIST" || option.unit.find(',') != std::string::npos);
  if (values.is_list) return values;
  for (const std::string_view part : alternatives(option.unit)) {
    if (const std::string word = literal(part); !word.empty()) values.words.push_back(word);
    if (part == "DIR" || part == "FOLDER") values.folders = true;
    const std::size_t name = part.find("FILE");
    const bool is_file = part.starts_with("FILE") || part.starts_with("NAME=FILE");
    if (!is_file) continue;
    values.files = true;
    values.extensions = extensions_in(option.help);
    if (part.substr(name).starts_with("FILE.")) values.extensions = {std::string(part.substr(name + 5))};
  }
  if (option.positional && values.words.empty()) {
    values.files = true;
    values.extensions = extensions_in(option.help);
  }
  return values;
}

}  // namespace gatelight::apps
