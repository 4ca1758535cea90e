#pragma once
// The emissive triangles of all instances, in world space.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/light/triangle_sampling.h"
#include "renderer/surface/rounding.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"
#include "scene/shutter.h"

namespace gatelight::renderer {

struct EmissiveTriangle {
  TriangleCorners corners;  ///< world space; counter-clockwise on the front, also for mirrored instances
  Vec3 normal{0, 0, 0};     ///< unit, on the front; zero if degenerate
  Color emission{0, 0, 0};  ///< radiance before texture and coverage
  std::uint32_t instance = 0;
  std::uint32_t primitive = 0;
  float area = 0.0f;
  float offset = 0.0f;  ///< in metres along the normal: bounds the rounding of a hit
  bool two_sided = false;
  bool plain = true;      ///< no emission texture and no alpha: the radiance is `emission` everywhere
  bool mirrored = false;  ///< edge1 ends in the file's third corner, edge2 in its second
};

class EmissiveTriangles {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Unlit materials do not emit. Their colour is visible but does not light the scene.
  EmissiveTriangles(const scene::Scene& scene, const Textures& textures);

  std::size_t size() const { return triangles_.size(); }
  const EmissiveTriangle& operator[](std::size_t i) const { return triangles_[i]; }

  /// The triangle at a time of the shutter. `moved` is the memory of one that moves.
  const EmissiveTriangle& at(std::size_t i, float time, EmissiveTriangle& moved) const {
    if (!moves_) return triangles_[i];
    moved = moved_to(triangles_[i], time);
    return moved;
  }
  /// The number of its states in an open shutter; 0 for one that stands still.
  std::size_t count_states(std::size_t i) const {
    return moves_ ? scene::count_states(scene_, triangles_[i].instance) : 0;
  }
  /// Whether any moves while the shutter is open.
  bool any_moves() const { return moves_; }

  /// The luminance of the radiant intensity along the normal in W/sr, by which lights are chosen. It is zero
  /// for degenerate triangles, for triangles with a black texture, and for all but the first of several in
  /// the same place. It is above zero for all others that emit.
  double intensity(std::size_t i) const { return intensities_[i]; }

  /// The index of a triangle, or of the first of several in the same place. kNone if the triangle does not
  /// emit.
  std::uint32_t find(std::uint32_t instance, std::uint32_t primitive) const {
    const std::uint32_t first = first_[instance];
    if (first == kNone) return kNone;
    return same_as_.empty() ? first + primitive : same_as_[first + primitive];
  }

  /// The radiance that leaves the front (and the back if two-sided), times the coverage of alpha.
  /// `barycentrics` are the weights of the ends of edge1 and edge2.
  Color radiance(const EmissiveTriangle& triangle, const Vec2& barycentrics) const {
    return triangle.plain ? triangle.emission : textured_radiance(triangle, barycentrics, 0.0f, true);
  }

  std::size_t bytes() const;

 private:
  Color textured_radiance(const EmissiveTriangle& triangle, const Vec2& barycentrics, float footprint,
                          bool cut_alpha) const;
  EmissiveTriangle moved_to(const EmissiveTriangle& triangle, float time) const;
  double estimate_intensity(const EmissiveTriangle& triangle) const;
  /// The area in the middle, or the largest of all states where that is much smaller: lamps that are hidden
  /// there, or grow.
  float area_in_shutter(const EmissiveTriangle& triangle) const;
  void find_duplicates();

  const scene::Scene& scene_;
  const Textures& textures_;
  bool moves_ = false;
  std::vector<PlacementRounding> roundings_;  ///< of instances that emit
  std::vector<EmissiveTriangle> triangles_;
  std::vector<double> intensities_;   ///< after construction only the tree's builder reads them
  std::vector<std::uint32_t> first_;  ///< for each instance the index of its first triangle, or kNone
  std::vector<std::uint32_t>
      same_as_;  ///< the first triangle with the same corners and material; empty if all differ
};

}  // namespace gatelight::renderer
