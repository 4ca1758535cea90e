#pragma once
// All options of `render`: those of the picture and those of the application.

#include <optional>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/settings/option.h"

namespace gatelight::apps {

/// In the order of the help, bound to the members of `settings`, which must outlive them.
std::vector<renderer::Option> option_table(RenderSettings& settings);

/// The options that decide the cache of a scene, for `info`; without SCENE.
std::vector<renderer::Option> cache_report_table(RenderSettings& settings);

/// The options of files with pictures. `stops` sets the exposure.
void add_picture_files(renderer::OptionGroup& group, std::vector<std::string>& outputs,
                       renderer::ImageWriteOptions& image, std::optional<float>& stops);

// Options that `sweep` has too.
renderer::Option external_option(bool& allowed);
renderer::Option progress_option(ProgressMode& mode);

/// A required positional argument.
renderer::Option positional(const char* name, std::string& member, const char* help);

}  // namespace gatelight::apps
