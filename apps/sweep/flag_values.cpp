#include "apps/sweep/flag_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "base/errors.h"

namespace gatelight::apps {

const std::string* find_flag(const FlagValues& flags, const std::string& flag) {
  const auto at = std::find_if(flags.begin(), flags.end(), [&](const auto& f) { return f.first == flag; });
  return at == flags.end() ? nullptr : &at->second;
}

void set_flag(FlagValues& flags, const std::string& flag, const std::string& value) {
  const auto at = std::find_if(flags.begin(), flags.end(), [&](const auto& f) { return f.first == flag; });
  if (at == flags.end()) {
    flags.emplace_back(flag, value);
  } else {
    at->second = value;
  }
}

bool drop_flag(FlagValues& flags, const std::string& flag) {
  return std::erase_if(flags, [&](const auto& f) { return f.first == flag; }) > 0;
}

std::vector<std::string> words_of(const FlagValues& flags) {
  std::vector<std::string> words;
  for (const auto& [flag, value] : flags) {
    // A value may begin with a dash: "--exposure -1" is parsed as meant, "--camera -x" is not.
    if (!value.empty() && value.front() == '-') {
      words.push_back(fmt::format("{}={}", flag, value));
    } else {
      words.insert(words.end(), {flag, value});
    }
  }
  return words;
}

std::vector<std::string> split_values(const std::string& option, const std::string& text,
                                      const std::string& flag) {
  const char separator = text.find(';') != std::string::npos ? ';' : ',';
  std::vector<std::string> values;
  if (flag == "--stack" && separator == ',') {
    values.push_back(text);
  } else {
    values = split(text, separator);
  }
  std::set<std::string> seen;
  for (const std::string& value : values) {
    if (value.empty()) {
      throw BadOption(
          {option, text, "",
           fmt::format("a list of values separated by {}", separator == ',' ? "commas" : "semicolons")});
    }
    if (!seen.insert(value).second) {
      throw BadOption({option, text, fmt::format("holds '{}' twice", value), "different values"});
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
  return {flag, split_values("vary", text.substr(equals + 1), flag)};
}

NamedRun parse_run(const std::string& text) {
  const std::size_t colon = text.find(':');
  NamedRun run{trimmed(text.substr(0, colon)), {}};
  if (colon == std::string::npos || run.name.empty()) throw BadOption({"run", text, "", "'NAME: FLAGS'"});
  std::istringstream words(text.substr(colon + 1));
  for (std::string flag; words >> flag;) {
    const std::size_t equals = flag.find('=');
    std::string value = equals == std::string::npos ? "" : flag.substr(equals + 1);
    if (flag.rfind("--", 0) != 0 || (equals == std::string::npos && !(words >> value)))
      throw BadOption({"run", flag, fmt::format("in '{}' is not a flag with a value", text)});
    set_flag(run.flags, flag.substr(0, equals), value);
  }
  return run;
}

std::vector<NamedRun> parse_runs(std::istream& lines) {
  std::vector<NamedRun> runs;
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line);
    if (!line.empty() && line.front() != '#') runs.push_back(parse_run(line));
  }
  return runs;
}

std::vector<NamedRun> read_runs(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) throw InputError(fmt::format("cannot read '{}', expected lines of 'NAME: FLAGS'", file));
  std::vector<NamedRun> runs = parse_runs(lines);
  if (runs.empty())
    throw InputError(fmt::format("'{}' holds no runs, expected lines of 'NAME: FLAGS'", file));
  return runs;
}

}  // namespace gatelight::apps
