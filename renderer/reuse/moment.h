#pragma once
// Where the things of a scene are at one time.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace gatelight::renderer {

/// What moves, as it is now: it outlives the scene's next times.
class Moment {
 public:
  Moment() = default;
  explicit Moment(const scene::Scene& scene);

  /// The corners of a triangle in world space, in the order of the scene's mesh. Nothing where the instance
  /// was hidden, or its mesh had other vertices.
  std::optional<std::array<Vec3, 3>> triangle(const scene::Scene& scene, std::uint32_t instance,
                                              std::uint32_t primitive) const;

 private:
  struct Place {
    Affine transform;
    bool hidden;
  };
  std::map<std::uint32_t, Place> moving_;       ///< by instance
  std::map<int, std::vector<Vec3>> deforming_;  ///< positions by mesh
};

}  // namespace gatelight::renderer
