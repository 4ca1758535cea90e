#pragma once
// The flags that the help of each subcommand has.

#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace gatelight::tests {

/// The first group of each line of a help that matches.
inline std::vector<std::string> found_in_help(const std::vector<std::string>& call,
                                              const std::string& pattern) {
  const std::regex regex(pattern);
  std::vector<std::string> found;
  std::istringstream lines(run_gatelight_inside(call).out);
  for (std::string line; std::getline(lines, line);) {
    if (std::smatch match; std::regex_search(line, match, regex)) found.push_back(match[1]);
  }
  EXPECT_FALSE(found.empty());
  return found;
}

inline std::vector<std::string> subcommands() {
  return found_in_help({"--help"}, "^  ([a-z]+) +[A-Z]");
}

/// "--spp" and so on, in the order of the help.
inline std::vector<std::string> flags_of(const std::string& subcommand) {
  return found_in_help({subcommand, "--help-all"}, "^  (?:-[a-z],)?(--[a-z0-9-]+)");
}

}  // namespace gatelight::tests
