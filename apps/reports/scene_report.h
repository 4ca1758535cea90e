#pragma once
// What `gatelight info SCENE` tells.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/requirements.h"
#include "scene/scene.h"

namespace gatelight::apps {

struct SceneReport {
  scene::SceneRequirements requirements;
  std::size_t triangles_stored = 0;
  std::size_t triangles = 0;  ///< each instance counted
  std::size_t geometry_bytes = 0;
  std::size_t image_bytes = 0;
  std::size_t render_bytes = 0;  ///< estimate for a picture with the default options, all included
  double load_seconds = 0.0;
};

SceneReport make_scene_report(const scene::Scene& scene, double load_seconds);

/// Lines, each with its line break.
std::string scene_report_text(const scene::Scene& scene, const SceneReport& report);
nlohmann::ordered_json scene_report_json(const scene::Scene& scene, const SceneReport& report);

}  // namespace gatelight::apps
