#pragma once
// The names and places of a scene that a page lists.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::apps {

struct SceneOutline {
  /// The page's: cameras in the file's order, names of lights and of emissive materials (`glowing`), each
  /// once, animations, the place of all and whether it has light.
  nlohmann::ordered_json json;
  std::vector<std::string> instances;  ///< names, by number
  std::vector<Box> boxes;              ///< of the instances, in the file's coordinates, as loaded

  /// The box of all instances that a placed mesh of the file consists of; none for an unknown number.
  std::optional<Box> object_around(std::size_t instance) const;

  std::vector<int> placements;  ///< of the instances (scene::Instance::placement)
};

SceneOutline outline_of(const scene::Scene& scene);

}  // namespace gatelight::apps
