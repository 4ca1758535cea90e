#pragma once
// Flags of `render` with their values, and the texts of axes and of named runs.

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

#include "apps/settings/parsing.h"

namespace gatelight::apps {

/// "--features" and "8".
using FlagValues = std::vector<std::pair<std::string, std::string>>;

const std::string* find_flag(const FlagValues& flags, const std::string& flag);
/// Replaces the value of a flag, or appends the flag.
void set_flag(FlagValues& flags, const std::string& flag, const std::string& value);
/// Removes a flag. Returns whether it was there.
bool drop_flag(FlagValues& flags, const std::string& flag);
std::vector<std::string> words_of(const FlagValues& flags);

struct SweepAxis {
  std::string flag;  ///< of `render`, with its dashes
  std::vector<std::string> values;
};

/// Splits "a,b" into two values, and "a,b;c" into "a,b" and "c". `flag` is that of `render`: values of
/// --stack are lists themselves and are not split at commas. Throws BadOption of `option` for empty and
/// repeated values.
std::vector<std::string> split_values(const std::string& option, const std::string& text,
                                      const std::string& flag = "");

/// The values in ascending order, each once.
std::vector<int> split_integers(const std::string& flag, const std::string& text, const IntegerRange& range);

/// Parses "NAME=V1,V2", the text of --vary. NAME is a flag of `render`, with or without its dashes. Which
/// flags may be varied is not checked here.
SweepAxis parse_vary(const std::string& text);

/// A single picture with flags of its own, by --run or --plan.
struct NamedRun {
  std::string name;
  FlagValues flags;
};

/// Parses "NAME: --flag value --flag=value". Which flags there are is not checked here. Throws BadOption.
NamedRun parse_run(const std::string& text);

/// Lines that are a run each. Empty ones and those that begin with # are left out. Throws BadOption.
std::vector<NamedRun> parse_runs(std::istream& lines);

/// The runs of a file. Throws InputError where it cannot be read or holds none, and BadOption.
std::vector<NamedRun> read_runs(const std::string& file);

}  // namespace gatelight::apps
