#pragma once
// All that emits, as one thing to sample: emissive triangles and point or spot lights in a light tree,
// directional lights and the environment beside it.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/light/emissive_triangles.h"
#include "renderer/light/environment.h"
#include "renderer/light/light_tree.h"
#include "renderer/sampling/alias_table.h"
#include "renderer/settings/choices.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct LightSample {
  Vec3 wi = Vec3::Zero();            ///< unit, from the point to the light
  float distance = 0.0f;             ///< metres; infinity for directional lights and the environment
  Color radiance{0.0f, 0.0f, 0.0f};  ///< unoccluded; for a delta light the irradiance on a plane facing it
  float pdf = 0.0f;  ///< choice and direction, per solid angle; for a delta light the choice alone; 0: none
  bool delta = false;
  // Where a shadow ray has to end not to meet the light itself: so many metres before its plane, which is
  // seen under this cosine.
  float offset = 0.0f;
  float cosine = 1.0f;
};

/// Thread-safe after construction; holds references to its arguments.
class Lights {
 public:
  Lights(const scene::Scene& scene, const Textures& textures, const Environment& environment,
         LightSelection selection);

  bool empty() const { return local_.empty() && distant_.empty() && environment_.black(); }

  /// A direction towards some light. n is the shading normal on the side of the viewer, or zero where light
  /// may arrive from all sides (transmission).
  LightSample sample(const Vec3& p, const Vec3& n, float u_select, const Vec2& u) const;

  /// Whether there are point, spot or directional lights.
  bool has_delta() const { return !placed_.empty() || !distant_.empty(); }
  /// As sample(), among those alone: what no direction of a BSDF ever finds. The density is the choice's.
  LightSample sample_delta(const Vec3& p, const Vec3& n, float u_select, const Vec2& u) const;

  /// Density with which sample(p, n) makes the direction wi that met this triangle at `distance`; 0 if it
  /// does not emit to that side. For multiple importance sampling.
  float pdf_triangle(const Vec3& p, const Vec3& n, std::uint32_t instance, std::uint32_t primitive,
                     const Vec3& wi, float distance) const;
  /// The same for a ray that left the scene.
  float pdf_environment(const Vec3& p, const Vec3& n, const Vec3& wi) const;

  /// Those that can be chosen: not degenerate, not black.
  std::size_t emissive_triangles() const { return emissive_count_; }
  std::size_t bytes() const;

 private:
  /// Lights with a position: one of the two is empty, or both if there is nothing to choose.
  struct Local {
    LightTree tree;
    AliasTable table;

    Local() = default;
    Local(const std::vector<LightBounds>& lights, LightSelection selection);
    bool empty() const { return tree.empty() && table.empty(); }
    /// The tree's, whose sum is zero if none can shine at the point; false then.
    bool reaches(const Vec3& p, const Vec3& n, LightTree::Weights& root) const;
    LightTree::Choice sample(const LightTree::Weights& root, const Vec3& p, const Vec3& n, double u) const;
    float probability(const Vec3& p, const Vec3& n, std::uint32_t light) const;
    std::size_t bytes() const { return tree.bytes() + table.bytes(); }
  };

  float pdf_local(const Vec3& p, const Vec3& n, std::uint32_t light) const;
  LightSample sample_triangle(const Vec3& p, std::uint32_t light, float choice, const Vec2& u) const;
  LightSample sample_placed(const Vec3& p, const scene::PunctualLight& light, float choice) const;
  /// The directional light with this number among those above the horizon of n.
  LightSample sample_distant(const Vec3& n, float choice, int number) const;
  LightSample sample_environment(const Vec3& n, float choice, const Vec2& u) const;

  int count_distant(const Vec3& n) const;
  /// A constant sky is found by the BSDF's own directions as well as by any others: it takes no light samples
  /// from lamps and suns, and is sampled only where there are none.
  bool samples_sky(int other_parts) const;

  const Environment& environment_;
  EmissiveTriangles triangles_;
  std::vector<scene::PunctualLight> placed_;   ///< point and spot lights
  std::vector<scene::PunctualLight> distant_;  ///< directional lights
  Local local_;                                ///< the triangles and, numbered after them, placed_
  Local local_placed_;                         ///< placed_ alone
  std::size_t emissive_count_ = 0;
};

}  // namespace gatelight::renderer
