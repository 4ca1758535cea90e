#pragma once
// The recipe of a picture, so that it can be made again.

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "renderer/image/picture.h"
#include "renderer/settings/statistics.h"

namespace gatelight::apps {

/// Every option with the value that was used, under the name of its flag. Where `reproducible` is set,
/// options that cannot change the picture (threads, progress, names of outputs) are left out.
nlohmann::ordered_json resolved_options(RenderSettings settings);

/// resolved_options() as JSON text.
std::string dump_options(const RenderSettings& settings);

/// The EXR header's strings.
std::map<std::string, std::string> make_recipe(RenderSettings settings,
                                               const std::vector<std::string>& command,
                                               const renderer::RenderStatistics& statistics,
                                               double seconds_so_far);

/// Every option of a picture that was read; discarded where it has no recipe.
nlohmann::ordered_json recipe_options(const renderer::Picture& picture);

}  // namespace gatelight::apps
