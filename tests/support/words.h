#pragma once
// Command lines.

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatelight::tests {

using Words = std::vector<std::string>;

/// The words of a line, in which each {} is the next of the values, and then `more`.
inline Words words_of(const std::string& line, const Words& values = {}, const Words& more = {}) {
  Words words;
  std::size_t used = 0;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) words.push_back(word == "{}" ? values.at(used++) : word);
  if (used != values.size()) throw std::invalid_argument("more values than {} in: " + line);
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace gatelight::tests
