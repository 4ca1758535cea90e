#pragma once
// Where the things of a scene are at one time, and of what material.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

/// What moves or changes, as it is now: it outlives the scene's next times.
class SceneSnapshot {
 public:
  SceneSnapshot() = default;
  explicit SceneSnapshot(const scene::Scene& scene);

  /// The corners of a triangle in world space, in the order of the scene's mesh. Nothing where the instance
  /// was hidden, or its mesh had other vertices.
  std::optional<std::array<Vec3, 3>> triangle(const scene::Scene& scene, std::uint32_t instance,
                                              std::uint32_t primitive) const;

  /// Whether materials change with the time.
  bool has_materials() const { return !materials_.empty(); }
  const scene::Material& material(const scene::Scene& scene, std::uint32_t instance) const {
    return materials_[static_cast<std::size_t>(scene.mesh_of(scene.instances[instance]).material)];
  }

 private:
  struct Place {
    Affine transform;
    bool hidden;
  };
  std::map<std::uint32_t, Place> moving_;       ///< by instance
  std::map<int, std::vector<Vec3>> deforming_;  ///< positions by mesh
  std::vector<scene::Material> materials_;      ///< of the scene; empty where they do not change
};

}  // namespace gatelight::renderer
