#include "apps/sweep/named_runs.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "apps/terminal/errors.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

std::string trimmed(const std::string& text) {
  constexpr const char* kSpaces = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpaces);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(kSpaces) - begin + 1);
}

}  // namespace

NamedRun parse_run(const std::string& text) {
  const std::size_t colon = text.find(':');
  NamedRun run{trimmed(text.substr(0, colon)), {}};
  if (colon == std::string::npos || run.name.empty()) throw BadOption({"run", text, "", "'NAME: FLAGS'"});
  std::istringstream words(text.substr(colon + 1));
  for (std::string flag; words >> flag;) {
    const std::size_t equals = flag.find('=');
    std::string value = equals == std::string::npos ? "" : flag.substr(equals + 1);
    if (flag.rfind("--", 0) != 0 || (equals == std::string::npos && !(words >> value)))
      throw BadOption({"run", flag, fmt::format("in '{}' is no flag with a value", text)});
    set_flag(run.flags, flag.substr(0, equals), value);
  }
  return run;
}

std::vector<NamedRun> read_runs(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) throw InputError(fmt::format("cannot read '{}', expected lines of 'NAME: FLAGS'", file));
  std::vector<NamedRun> runs;
  for (std::string line; std::getline(lines, line);) {
    line = trimmed(line);
    if (!line.empty() && line.front() != '#') runs.push_back(parse_run(line));
  }
  if (runs.empty())
    throw InputError(fmt::format("'{}' holds no runs, expected lines of 'NAME: FLAGS'", file));
  return runs;
}

}  // namespace gatelight::apps
