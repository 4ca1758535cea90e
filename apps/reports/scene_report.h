#pragma once
// The report of `gatelight info SCENE`.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/requirements.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// Lines, each with its line break.
std::string scene_report_text(const scene::Scene& scene, const scene::SceneRequirements& requirements,
                              double load_seconds);
nlohmann::ordered_json scene_report_json(const scene::Scene& scene,
                                         const scene::SceneRequirements& requirements, double load_seconds);

}  // namespace gatelight::apps
