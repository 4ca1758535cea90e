#pragma once
// The names and places of a scene that a page lists.

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace gatelight::apps {

struct SceneOutline {
  struct NamedCamera {
    std::string name;
    bool orthographic = false;
  };
  std::vector<NamedCamera> cameras;  ///< in the file's order
  std::vector<std::string> lights;   ///< punctual ones, each name once
  std::vector<std::string> glowing;  ///< emissive materials
  std::vector<scene::Animation> animations;
  std::vector<std::string> instances;  ///< names, by number
  std::vector<Box> boxes;              ///< of the instances, in the file's coordinates, as loaded
  Vec3 center = Vec3::Zero();
  float radius = 1.0f;  ///< metres
  bool has_own_light = false;

  /// The box of all instances that a placed mesh of the file consists of; none for an unknown number.
  std::optional<Box> object_around(std::size_t instance) const;

  std::vector<int> placements;  ///< of the instances (scene::Instance::placement)
};

SceneOutline outline_of(const scene::Scene& scene);

}  // namespace gatelight::apps
