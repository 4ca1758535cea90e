#pragma once
// Points of surfaces that are shaded together, by the kernels or by the scalar code.

#include <algorithm>
#include <optional>
#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "renderer/shading/block.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// Whether the kernels support all lobes of a surface. They do not support refraction into an inside
/// and kScalarLobes.
inline bool kernels_shade(const Surface& surface) {
  const SurfaceMaterial& m = surface.material;
  for (float SurfaceMaterial::*const lobe : kScalarLobes) {
    if (m.*lobe > 0.0f) return false;
  }
  return m.thin_walled || !(m.transmission > 0.0f || m.diffuse_transmission > 0.0f);
}

/// Fills what the scalar code reads of a lane's surface besides ScalarLane. `wo` is unit, away from the
/// surface.
void put_geometry(ShadingBlock& block, int lane, const Surface& surface, const Vec3& wo);
/// Fills a lane's surface for the kernels.
void put_surface(ShadingBlock& block, int lane, const Surface& surface, const Vec3& wo);

/// What the scalar code needs of a point besides the block.
struct ScalarLane {
  std::optional<Bsdf> bsdf;
  bool thin_walled = false;
  bool only_panes = false;      ///< the path only passes panes: no light sample, and no scattering
  bool front_lights = false;    ///< light samples from behind are left out, because bounces find that light
  float radiance_scale = 1.0f;  ///< output: BsdfSample::radiance_scale, which the weights leave out
};

/// Fills its lobes.
inline void put_lobes(ScalarLane& lane, const Surface& surface, const Vec3& wo) {
  lane.bsdf.emplace(surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal,
                    wo, surface.front);
  lane.thin_walled = surface.material.thin_walled;
}

/// The points go either all to the kernels or all to the scalar code, which has the same outputs.
struct SurfaceBlock {
  ShadingBlock points;
  std::vector<ScalarLane> scalar;  ///< one for each lane, or empty: for the kernels

  bool full() const { return points.count == ShadingBlock::kWidth; }
};

inline Vec3 lane_vector(const float (&a)[3][ShadingBlock::kWidth], int lane) {
  return {a[0][lane], a[1][lane], a[2][lane]};
}
/// The normal that next-event estimation uses: zero on a sheet, which light reaches from both sides.
inline Vec3 light_normal(const ShadingBlock& block, int lane) {
  const float transmission = std::max(block.transmission[lane], block.diffuse_transmission[lane]);
  const bool sheet = transmission * (1.0f - block.metallic[lane]) > 0.0f;
  return sheet ? Vec3(Vec3::Zero()) : lane_vector(block.shading_normal, lane);
}
inline Color lane_color(const float (&a)[3][ShadingBlock::kWidth], int lane) {
  return {a[0][lane], a[1][lane], a[2][lane]};
}

template <class Vector>
void put_lane(float (&a)[3][ShadingBlock::kWidth], int lane, const Vector& v) {
  for (int c = 0; c < 3; ++c) a[c][lane] = v[c];
}

}  // namespace gatelight::renderer
