#pragma once
// The command line of `render` for callers that are not a command line: words into settings.

#include <string>
#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

struct RenderFlag {
  std::string name;  ///< with its dashes
  bool takes_value = true;
};

/// Those of `gatelight render`, without the scene and --help.
std::vector<RenderFlag> render_flags();

/// What `gatelight render SCENE WORDS` asks for, presets applied; complete_settings() comes after it. Outputs
/// may be missing. Throws UsageError.
RenderSettings read_render_words(const std::string& scene, const std::vector<std::string>& words);

}  // namespace gatelight::apps
