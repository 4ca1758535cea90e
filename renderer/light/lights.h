#pragma once
// Samples all lights of the scene: emissive triangles, point and spot lights by a light tree; directional
// lights and the environment separately.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/light/emissive_triangles.h"
#include "renderer/light/environment.h"
#include "renderer/light/light_tree.h"
#include "renderer/sampling/alias_table.h"
#include "renderer/settings/enums.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

struct LightSample {
  Vec3 wi = Vec3::Zero();            ///< unit, from the point to the light
  float distance = 0.0f;             ///< in metres; infinity for directional lights and the environment
  Color radiance{0.0f, 0.0f, 0.0f};  ///< unoccluded; for a delta light the irradiance on a plane facing it
  float pdf = 0.0f;  ///< per solid angle; for a delta light the probability of the choice; 0 means no sample
  bool delta = false;
  // A shadow ray must end `offset` metres before the plane of the light, so that it does not hit the light.
  // `cosine` is between the ray and the light's normal.
  float offset = 0.0f;
  float cosine = 1.0f;
  std::uint32_t light = 0;  ///< its number: triangles, placed and directional lights, then the environment
};

/// Thread-safe after construction; holds references to its arguments.
class Lights {
 public:
  /// `constant_sky`: whether a constant environment gets light samples; empty: if there are no other lights.
  Lights(const scene::Scene& scene, const Textures& textures, const Environment& environment,
         LightSelection selection, std::optional<bool> constant_sky = {});

  bool empty() const { return local_.empty() && distant_.empty() && environment_.black(); }

  /// Samples a direction towards a light. `n` is the shading normal on the side of the viewer, or zero where
  /// light may arrive from all sides (transmission). `time` is one of the shutter, in [0, 1]; directional
  /// lights stand still in it.
  LightSample sample(const Vec3& p, const Vec3& n, float u_select, const Vec2& u,
                     float time = scene::kShutterMiddle) const;

  /// Whether there are lights with a position.
  bool has_local() const { return !local_.empty(); }

  /// The point of a light that sample(from, 0, ...) has returned, as seen from `p`: with the pdf that
  /// sample(p, 0, ...) has for it. The pdf is 0 if it could not return it; the radiance is 0 if no light of
  /// the point arrives there, or it has no position.
  LightSample same_point_from(const Vec3& p, const LightSample& sample, const Vec3& from,
                              float time = scene::kShutterMiddle) const;

  /// Whether there are point, spot or directional lights.
  bool has_delta() const { return !placed_.empty() || !distant_.empty(); }
  /// Like sample(), for only these lights, which BSDF sampling never finds. The pdf is the probability of the
  /// choice.
  LightSample sample_delta(const Vec3& p, const Vec3& n, float u_select, const Vec2& u,
                           float time = scene::kShutterMiddle) const;

  /// The pdf with which sample(p, n) returns the direction wi that hit this triangle at `distance`. 0 if the
  /// triangle does not emit to that side. For multiple importance sampling.
  float pdf_triangle(const Vec3& p, const Vec3& n, std::uint32_t instance, std::uint32_t primitive,
                     const Vec3& wi, float distance, float time = scene::kShutterMiddle) const;
  /// The same for a direction that leaves the scene.
  float pdf_environment(const Vec3& p, const Vec3& n, const Vec3& wi) const;

  /// Whether lights with a position move while the shutter is open.
  bool moves() const { return triangles_.any_moves() || !placed_states_.empty(); }

  /// The number of triangles that can be chosen: not degenerate, not black.
  std::size_t emissive_triangles() const { return emissive_count_; }
  std::size_t bytes() const;

  /// Whether the environment gets light samples, beside other lights or without them.
  bool samples_sky(bool beside_others) const {
    if (environment_.black()) return false;
    return !environment_.constant() || constant_sky_.value_or(!beside_others);
  }

  // For the kernels. Light `i` of the tree is triangle i, or placed light i - triangles().size().
  const Environment& environment() const { return environment_; }
  const EmissiveTriangles& triangles() const { return triangles_; }
  const std::vector<scene::PunctualLight>& placed() const { return placed_; }
  const std::vector<scene::PunctualLight>& distant() const { return distant_; }
  /// Null where lights with a position are chosen by power.
  const LightTree* tree() const { return local_.table.empty() ? &local_.tree : nullptr; }
  /// The same for only the placed lights, numbered from 0, for sample_delta().
  const LightTree* placed_tree() const { return local_placed_.table.empty() ? &local_placed_.tree : nullptr; }

 private:
  /// Lights with a position, in a tree or in a table. The other one is empty; both are empty if there is
  /// nothing to choose.
  struct Local {
    LightTree tree;
    AliasTable table;

    Local() = default;
    Local(const std::vector<LightBounds>& lights, LightSelection selection);
    bool empty() const { return tree.empty() && table.empty(); }
    /// Sets `root` to the tree's weights. Returns false if no light can reach the point.
    bool reaches(const Vec3& p, const Vec3& n, LightTree::Weights& root) const;
    LightTree::Choice sample(const LightTree::Weights& root, const Vec3& p, const Vec3& n, double u) const;
    float probability(const Vec3& p, const Vec3& n, std::uint32_t light) const;
    std::size_t bytes() const { return tree.bytes() + table.bytes(); }
  };

  float pdf_local(const Vec3& p, const Vec3& n, std::uint32_t light) const;
  float pdf_triangle(const Vec3& p, const Vec3& n, std::uint32_t light, const EmissiveTriangle& triangle,
                     const Vec3& wi, float distance) const;
  LightSample sample_triangle(const Vec3& p, std::uint32_t light, float choice, const Vec2& u,
                              float time) const;
  /// `number` is the index in placed_.
  LightSample sample_placed(const Vec3& p, std::size_t number, float choice, float time) const;
  LightSample sample_placed(const Vec3& p, std::size_t number, float choice,
                            const scene::PunctualLight& light) const;
  LightBounds bounds_of_triangle(std::size_t number) const;
  LightBounds bounds_of_placed(std::size_t number) const;
  scene::PunctualLight placed_at(std::size_t number, float time) const;
  /// Samples the directional light with this number among those above the horizon of n.
  LightSample sample_distant(const Vec3& n, float choice, int number) const;
  LightSample sample_environment(const Vec3& n, float choice, const Vec2& u) const;

  int count_distant(const Vec3& n) const;

  const Environment& environment_;
  /// BSDF sampling finds a constant environment as well as light samples do, so it is sampled only where
  /// there are no other lights, unless this says otherwise.
  std::optional<bool> constant_sky_;
  EmissiveTriangles triangles_;
  std::vector<scene::PunctualLight> placed_;   ///< point and spot lights
  std::vector<scene::PunctualLight> distant_;  ///< directional lights
  /// States of placed_ in an open shutter; empty if all stand still.
  std::vector<std::vector<scene::LightPlace>> placed_states_;
  Local local_;         ///< the triangles, and then placed_
  Local local_placed_;  ///< only placed_
  std::size_t emissive_count_ = 0;
};

}  // namespace gatelight::renderer
