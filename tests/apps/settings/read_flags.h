#pragma once
// Flags of `gatelight render`, read without a scene.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "apps/settings/complete_settings.h"
#include "apps/settings/config_file.h"
#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"
#include "tests/support/messages.h"
#include "tests/support/words.h"

namespace gatelight::apps {

using tests::Words;
using tests::words_of;

/// Settings of `gatelight render room.glb -o a.exr WORDS`.
inline RenderSettings read_flags(Words words) {
  CLI::App root("", "gatelight");
  root.fallthrough();
  accept_config_file(root);
  CLI::App* app = root.add_subcommand("render", "");
  RenderSettings settings;
  add_flags(*app, option_table(settings));
  words.insert(words.begin(), {"render", "room.glb", "-o", "a.exr"});
  std::reverse(words.begin(), words.end());
  root.parse(words);
  finish_flags(*app, settings);
  complete_settings(settings);
  return settings;
}

inline Words with_cache(Words words) {
  words.insert(words.begin(), {"--integrator", "nrc"});
  return words;
}

inline renderer::CacheOptions read_cache(const Words& words) {
  return read_flags(with_cache(words)).render.cache;
}

inline ErrorParts refused_flags(const Words& words) {
  return tests::refused_parts<BadOption>([&] { read_flags(words); });
}

inline std::set<std::string> cache_names() {
  RenderSettings settings;
  std::set<std::string> names;
  for (const Option& option : option_table(settings)) {
    if (option.marks.of_cache) names.insert(option.name);
  }
  return names;
}

}  // namespace gatelight::apps
