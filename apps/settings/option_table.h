#pragma once
// All options of `render`: those of the picture and those of the application.

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "apps/settings/option.h"
#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// In the order of the help, bound to the members of `settings`, which must outlive them.
std::vector<Option> option_table(RenderSettings& settings);

/// The names of those that `fits` accepts, without SCENE.
std::set<std::string> option_names(const std::function<bool(const Option&)>& fits);

/// The options that decide the cache of a scene, for `info`; without SCENE.
std::vector<Option> cache_report_table(RenderSettings& settings);

// Options that `sweep` has too.
Option external_option(bool& allowed);
Option progress_option(ProgressMode& mode);

/// A required positional argument.
Option positional(const char* name, std::string& member, const char* help);

}  // namespace gatelight::apps
