#pragma once
// The surface at a hit: position, normals, textured material and emission.

#include <cstdint>
#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/rounding.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"
#include "scene/shutter.h"

namespace gatelight::renderer {

/// A ray's cone, for the choice of mip levels (Akenine-Moeller et al. 2019, "Texture level of detail
/// strategies").
struct RayCone {
  float width = 0.0f;   ///< in metres, at the origin of the ray
  float spread = 0.0f;  ///< in radians: growth of the width per metre
};

struct Surface {
  Vec3 position = Vec3::Zero();
  /// Unit, on the side of the viewer; bounds the incident directions. On the round surface of vertex normals
  /// (shadow_terminator.h) it is the smooth normal.
  Vec3 geometric_normal = Vec3::Zero();
  Vec3 shading_normal = Vec3::Zero();  ///< unit, on the side of the viewer, normal map applied
  Vec3 smooth_normal = Vec3::Zero();   ///< unit, on the side of the viewer, without the normal map
  Vec3 coat_normal = Vec3::Zero();     ///< unit, on the side of the viewer
  float offset = 0.0f;  ///< in metres along the geometric normal: bounds the error of `position`
  bool front = true;    ///< whether the viewer is on the front side
  bool unlit = false;
  Color emission{0.0f, 0.0f, 0.0f};  ///< radiance towards the viewer
  SurfaceMaterial material;

  /// The origin of a new ray towards `direction`.
  Vec3 spawn(const Vec3& direction) const {
    return position + geometric_normal * (geometric_normal.dot(direction) < 0.0f ? -offset : offset);
  }
};

/// Thread-safe after construction; holds references to its arguments.
class Surfaces {
 public:
  Surfaces(const scene::Scene& scene, const Textures& textures);

  /// `cone_width` is the ray cone's width at the hit, in metres. `u_level` in [0, 1) chooses between mip
  /// levels.
  Surface at(const Hit& hit, const Vec3& direction, float cone_width, float u_level) const;
  /// The same with another material in place of the instance's own.
  Surface at(const Hit& hit, const Vec3& direction, float cone_width, float u_level,
             const scene::Material& material) const;

  /// Prefetches for a batch of hits, to call some hits ahead of at(): first the indices of the triangle, then
  /// the vertices. Vertex reads are scattered, and each would stall.
  void prefetch_triangle(const Hit& hit) const {
    if (hit) __builtin_prefetch(&views_[hit.instance].mesh->triangles[hit.primitive]);
  }
  void prefetch_vertices(const Hit& hit) const;

  const scene::Material& material(std::uint32_t instance) const { return *views_[instance].material; }

 private:
  struct View {
    const scene::Mesh* mesh = nullptr;
    const scene::Material* material = nullptr;
    Eigen::Matrix3f normal_matrix = Eigen::Matrix3f::Identity();
    Affine transform = Affine::Identity();
    PlacementRounding rounding;
    bool baked = true;
    bool swaps_handedness = false;
    /// States of the open shutter; null for what stands still in it.
    const std::vector<Affine>* transforms = nullptr;
    const std::vector<scene::DeformedVertices>* vertices = nullptr;
    float time = scene::kShutterMiddle;  ///< of the vertices

    bool is_blurred() const { return transforms != nullptr || vertices != nullptr; }
    View at(float shutter_time) const;

    // Vertices of the mesh.
    Vec3 position(std::uint32_t vertex) const;
    Vec3 normal(std::uint32_t vertex) const;
    Vec4 tangent(std::uint32_t vertex) const;

    /// A unit vector, or zero; `turn` negates it.
    Vec3 world_normal(const Vec3& normal, bool turn) const;
  };
  struct Place;

  Surface at(const View& view, const Hit& hit, const Vec3& direction, float cone_width, float u_level) const;
  /// Fills the position and the normals of `surface`.
  static Place place(const View& view, const Hit& hit, const Vec3& direction, Surface& surface);

  const Textures& textures_;
  std::vector<View> views_;
};

}  // namespace gatelight::renderer
