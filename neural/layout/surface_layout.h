#pragma once
// The geometry of the surfaces that a cache covers.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "neural/layout/vector_types.h"

namespace gatelight::neural {

/// A triangle mesh with welded vertices: equal positions have one index, whatever their normals and texture
/// coordinates (see weld_vertices). Triangles that share indices share nodes.
struct SurfaceMesh {
  std::span<const Float3> positions;                        ///< object space
  std::span<const std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
};

/// The sides of an instance that have their own storage. A side without storage uses the other side's. With
/// `none` the instance has no storage: its points encode to zero and training ignores its records.
enum class Sides : std::uint8_t { none = 0, front = 1, back = 2, both = 3 };

struct SurfaceInstance {
  std::uint32_t mesh = 0;
  std::array<float, 12> object_to_world = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};  ///< 3x4, column-major
  Sides sides = Sides::front;
  /// Multiplies the node spacing (rule `uniform`) and the clusters' cells; 2 makes the surface half as fine.
  /// Positive and finite.
  float spacing_scale = 1.0f;
};

struct SurfaceLayout {
  std::vector<SurfaceMesh> meshes;
  std::vector<SurfaceInstance> instances;
};

/// The geometric normal (right-hand rule over the corners, world space) points to side 0.
constexpr std::uint32_t surface_index(std::uint32_t instance, std::uint32_t side) {
  return 2 * instance + side;
}

/// Returns, for each position, the index of the first position with the same three floats (-0 equals 0).
/// Throws BadConfiguration for 2^31 positions or more.
std::vector<std::uint32_t> weld_vertices(std::span<const Float3> positions);

}  // namespace gatelight::neural
