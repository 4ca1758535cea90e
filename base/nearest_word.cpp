#include "base/nearest_word.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>
#include <utility>

namespace gatelight {
namespace {

/// Longer words come from damaged files rather than from typing.
constexpr std::size_t kLongest = 64;

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Number of letters to insert, delete or replace, or of neighbours to swap (optimal string alignment),
/// computed row by row.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = last[j] + (same_letter(a[i], b[j]) ? 0 : 1);
      row[j + 1] = std::min({replaced, row[j] + 1, last[j + 1] + 1});
      const bool swapped = i > 0 && j > 0 && same_letter(a[i], b[j - 1]) && same_letter(a[i - 1], b[j]);
      if (swapped) row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_word(std::string_view text, const std::vector<std::string>& words) {
  if (text.size() > kLongest) return "";
  // If every letter differs, no word is near, as for a wrong number.
  std::size_t limit = std::min(std::max<std::size_t>(1, text.size() / 3) + 1, text.size());
  std::string nearest;
  for (const std::string& word : words) {
    if (word.empty() || word.size() > kLongest) continue;
    const std::size_t distance = edit_distance(text, word);
    if (distance >= limit) continue;
    limit = distance;
    nearest = word;
  }
  return nearest;
}

std::string did_you_mean(std::string_view text, const std::vector<std::string>& words) {
  const std::string word = nearest_word(text, words);
  return word.empty() ? "" : "; did you mean '" + word + "'?";
}

}  // namespace gatelight
