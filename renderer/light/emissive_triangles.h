#pragma once
// The triangles that emit, each instance counted, in world space.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/light/triangle_sampling.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct EmissiveTriangle {
  TriangleCorners corners;  ///< world; counter-clockwise is the front, for mirrored instances too
  Vec3 normal{0, 0, 0};     ///< unit, of the front; zero where degenerate
  Color emission{0, 0, 0};  ///< radiance before texture and coverage
  std::uint32_t instance = 0;
  std::uint32_t primitive = 0;
  float area = 0.0f;
  float offset = 0.0f;  ///< metres along the normal within which a ray may meet it: rounding
  bool two_sided = false;
  bool plain = true;      ///< neither emission texture nor alpha: radiance is `emission` everywhere
  bool mirrored = false;  ///< edge1 ends in the file's third corner, edge2 in its second
};

class EmissiveTriangles {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Materials that are unlit emit nothing: their colour is what is seen, and lights nothing.
  EmissiveTriangles(const scene::Scene& scene, const Textures& textures);

  std::size_t size() const { return triangles_.size(); }
  const EmissiveTriangle& operator[](std::size_t i) const { return triangles_[i]; }

  /// Radiant intensity along the normal, W/sr, as a luminance: what the choice of lights goes by. Zero for
  /// degenerate triangles, for those whose texture is black everywhere, and for all but the first of several
  /// in the same place; never zero for any other that emits.
  double intensity(std::size_t i) const { return intensities_[i]; }

  /// kNone where the triangle does not emit. Of several in the same place the first.
  std::uint32_t find(std::uint32_t instance, std::uint32_t primitive) const {
    const std::uint32_t first = first_[instance];
    if (first == kNone) return kNone;
    return same_as_.empty() ? first + primitive : same_as_[first + primitive];
  }

  /// Radiance leaving the front (or the back, where two-sided) at these barycentric weights of the ends of
  /// edge1 and edge2, times the coverage of alpha.
  Color radiance(const EmissiveTriangle& triangle, const Vec2& barycentrics) const {
    return triangle.plain ? triangle.emission : textured_radiance(triangle, barycentrics, 0.0f, true);
  }

  std::size_t bytes() const;

 private:
  Color textured_radiance(const EmissiveTriangle& triangle, const Vec2& barycentrics, float footprint,
                          bool cut_alpha) const;
  double estimate_intensity(const EmissiveTriangle& triangle) const;
  void find_duplicates();

  const scene::Scene& scene_;
  const Textures& textures_;
  std::vector<EmissiveTriangle> triangles_;
  std::vector<double> intensities_;   ///< after construction read by the tree's builder only
  std::vector<std::uint32_t> first_;  ///< for each instance the index of its first triangle, or kNone
  std::vector<std::uint32_t>
      same_as_;  ///< the first triangle with the same corners and material; empty: all differ
};

}  // namespace gatelight::renderer
