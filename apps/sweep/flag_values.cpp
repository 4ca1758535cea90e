#include "apps/sweep/flag_values.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace gatelight::apps
