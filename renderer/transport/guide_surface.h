#pragma once
// The surface that a path sees first if mirrors and clear glass do not count: what guides the
// denoiser.

#include "renderer/film/camera_sample.h"
#include "renderer/transport/walker.h"

namespace gatelight::renderer {

/// Nearly all light leaves it in one direction, or two.
inline bool is_mirror_or_clear(const SurfaceMaterial& m) {
  constexpr float kSmooth = 0.1f;    // perceptual roughness
  constexpr float kDiffuse = 0.05f;  // share of what is scattered
  return m.roughness * m.roughness + m.anisotropy * m.anisotropy <= kSmooth * kSmooth &&
         (1.0f - m.metallic) * (1.0f - m.transmission) <= kDiffuse && !(m.sheen_color > 0.0f).any();
}

/// A path has met a surface; first_hit() is known. Where all before were mirrors or clear, it guides in their
/// place.
inline void meet_guide(Walker& path, const Meeting& m, FirstHit& first) {
  if (!path.sees_through) return;
  if (path.surfaces > 0) {
    GuideSurface& guide = first.guide;
    guide.surface = path.surfaces;
    guide.tint = path.throughput.min(1.0f);
    guide.albedo = guide.tint * m.surface.material.base_color;
    guide.normal = m.surface.shading_normal;
  }
  path.sees_through = is_mirror_or_clear(m.surface.material);
}

/// What the surface where the path is reflects, as its BSDF tells.
inline void set_albedo(const Walker& path, const Color& albedo, FirstHit& first) {
  if (path.surfaces == 0) first.albedo = albedo;
  if (path.surfaces == first.guide.surface) first.guide.albedo = first.guide.tint * albedo;
}

/// A path has left the scene. Behind mirrors and clear glass the sky is no surface.
inline void leave_guide(const Walker& path, FirstHit& first) {
  first.alpha -= path.background();
  if (path.sees_through) first.guide.hit = false;
}

}  // namespace gatelight::renderer
