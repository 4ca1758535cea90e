#pragma once
// Every option of `render`: those of the picture, and those that the application alone knows.

#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/settings/option.h"

namespace gatelight::apps {

/// In the order of the help, bound to the members of `settings`, which must outlive them.
std::vector<renderer::Option> option_table(RenderSettings& settings);

/// Those of them that decide what the cache of a scene is, for `info`; without SCENE.
std::vector<renderer::Option> cache_report_table(RenderSettings& settings);

// Those that `sweep` has, too.
renderer::Option external_option(bool& allowed);
renderer::Option progress_option(ProgressMode& mode);

/// A word without dashes, which has to be there.
renderer::Option positional(const char* name, std::string& member, const char* help);

}  // namespace gatelight::apps
