#pragma once
// The axes of a sweep.

#include <string>
#include <vector>

#include "apps/settings/parsing.h"

namespace gatelight::apps {

struct SweepAxis {
  std::string flag;  ///< of `render`, with its dashes
  std::vector<std::string> values;
};

/// Splits "a,b" into two values, and "a,b;c" into "a,b" and "c". Values that are lists themselves (--stack)
/// are not split at commas. Throws BadOption for empty and repeated values.
std::vector<std::string> split_values(const std::string& flag, const std::string& text,
                                      bool values_are_lists = false);

/// The values in ascending order, each once.
std::vector<int> split_integers(const std::string& flag, const std::string& text, const IntegerRange& range);

/// Parses "NAME=V1,V2", the text of --vary. NAME is a flag of `render`, with or without its dashes. Which
/// flags may be varied is not checked here.
SweepAxis parse_vary(const std::string& text);

}  // namespace gatelight::apps
