#pragma once
// The values of an option, as its placeholder and its help name them.

#include <string>
#include <string_view>
#include <vector>

#include "apps/settings/option.h"

namespace gatelight::apps {

struct Values {
  /// "auto", "none"; "fixed:" goes on, and so does each word that ends in another character than a letter or
  /// digit.
  std::vector<std::string> words;
  bool is_list = false;  ///< words, separated by commas
  bool files = false;
  bool folders = false;
  std::vector<std::string> extensions;  ///< of the files, without their points; empty: any
};

/// From a placeholder such as "auto|none|FILE" and a help that names ".exr".
Values values_of(const Option& option);

}  // namespace gatelight::apps
