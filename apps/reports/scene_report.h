#pragma once
// The report of `gatelight info SCENE`.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/settings/enum_names.h"
#include "scene/requirements.h"
#include "scene/scene.h"

namespace gatelight::apps {

inline constexpr renderer::Choice<scene::LightType> kLightTypes[] = {
    {"directional", scene::LightType::directional},
    {"point", scene::LightType::point},
    {"spot", scene::LightType::spot}};

/// Lines, each with its line break.
std::string scene_report_text(const scene::Scene& scene, const scene::SceneRequirements& requirements,
                              double load_seconds);
nlohmann::ordered_json scene_report_json(const scene::Scene& scene,
                                         const scene::SceneRequirements& requirements, double load_seconds);

}  // namespace gatelight::apps
