#pragma once
// Flags of `render` with their values, in order.

#include <string>
#include <utility>
#include <vector>

namespace gatelight::apps {

/// "--features" and "8".
using FlagValues = std::vector<std::pair<std::string, std::string>>;

const std::string* find_flag(const FlagValues& flags, const std::string& flag);
/// Replaces the value of a flag, or appends the flag.
void set_flag(FlagValues& flags, const std::string& flag, const std::string& value);
/// Removes a flag. Returns whether it was there.
bool drop_flag(FlagValues& flags, const std::string& flag);
std::vector<std::string> words_of(const FlagValues& flags);

}  // namespace gatelight::apps
