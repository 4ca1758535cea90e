#include "apps/sweep/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "apps/settings/parsing.h"
#include "apps/terminal/errors.h"

namespace gatelight::apps {

std::vector<std::string> split_values(const std::string& flag, const std::string& text,
                                      bool values_are_lists) {
  const char separator = text.find(';') != std::string::npos ? ';' : ',';
  std::vector<std::string> values;
  if (values_are_lists && separator == ',') {
    values.push_back(text);
  } else {
    values = split(text, separator);
  }
  std::set<std::string> seen;
  for (const std::string& value : values) {
    if (value.empty()) {
      throw BadOption(
          {flag, text, "",
           fmt::format("a list of values separated by {}", separator == ',' ? "commas" : "semicolons")});
    }
    if (!seen.insert(value).second) {
      throw BadOption({flag, text, fmt::format("holds '{}' twice", value), "different values"});
    }
  }
  return values;
}

std::vector<int> split_integers(const std::string& flag, const std::string& text, const IntegerRange& range) {
  std::vector<int> values;
  for (const std::string& word : split_values(flag, text)) {
    values.push_back(static_cast<int>(parse_integer(flag, word, range)));
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

SweepAxis parse_vary(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw BadOption({"vary", text, "", "NAME=V1,V2 with the name of a flag of render"});
  }
  const std::string name = text.substr(0, equals);
  const std::string flag = name.rfind("--", 0) == 0 ? name : fmt::format("--{}", name);
  std::vector<std::string> values = split_values("vary", text.substr(equals + 1), flag == "--stack");
  return {flag, std::move(values)};
}

}  // namespace gatelight::apps
