#pragma once
// Help for a misspelt word.

#include <string>
#include <string_view>
#include <vector>

namespace gatelight {

/// The word that is nearest to `text` by edit distance, upper and lower case alike; the first of several.
/// Empty where none is near: at most a third of the letters differ, or one.
std::string nearest_word(std::string_view text, const std::vector<std::string>& words);

/// "; did you mean 'WORD'?" for the end of a message; empty where no word is near.
std::string did_you_mean(std::string_view text, const std::vector<std::string>& words);

}  // namespace gatelight
