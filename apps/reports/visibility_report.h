#pragma once
// Which rays see what, and which objects the lights concern, where that is not all.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::apps {

/// "'wall' without camera, shadow", "'cut' holdout"; one line each.
std::vector<std::string> describe_visibility(const scene::Scene& scene);
nlohmann::ordered_json visibility_json(const scene::Scene& scene);

/// "light 'key' lights only 'hero'", "environment is blocked by all but 'glass'"; one line each.
std::vector<std::string> describe_light_links(const scene::Scene& scene);
nlohmann::ordered_json light_links_json(const scene::Scene& scene);

}  // namespace gatelight::apps
