#pragma once
// All that the cache knows of geometry.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "neural/base/batch.h"

namespace gatelight::neural {

/// A triangle mesh whose vertices are welded: one index for one position, whatever its normals and texture
/// coordinates (weld_vertices makes such indices). Two triangles share nodes where they share indices.
struct SurfaceMesh {
  std::span<const Float3> positions;                        ///< object space
  std::span<const std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
};

/// Which sides of an instance get storage of their own. The side that has none answers with the other one's;
/// an instance with neither has no storage: its points encode to zero and its records are not learned.
enum class Sides : std::uint8_t { none = 0, front = 1, back = 2, both = 3 };

struct SurfaceInstance {
  std::uint32_t mesh = 0;
  std::array<float, 12> object_to_world = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};  ///< 3x4, column-major
  Sides sides = Sides::front;
  /// Multiplies the node spacing (rule `uniform`) and the clusters' cells: 2 for a surface that may be half
  /// as fine. Positive and finite.
  float spacing_scale = 1.0f;
};

struct SurfaceLayout {
  std::vector<SurfaceMesh> meshes;
  std::vector<SurfaceInstance> instances;
};

/// Side 0 is the one that the geometric normal (right-hand rule over the corners, in world space) points to.
constexpr std::uint32_t surface_index(std::uint32_t instance, std::uint32_t side) {
  return 2 * instance + side;
}

/// For each position the index of the first position with the same three floats (-0 equals 0).
std::vector<std::uint32_t> weld_vertices(std::span<const Float3> positions);

}  // namespace gatelight::neural
