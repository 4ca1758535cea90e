#pragma once
// The first surface of a path that is neither a mirror nor clear glass. It guides the denoiser.

#include "renderer/film/camera_sample.h"
#include "renderer/transport/path_state.h"

namespace gatelight::renderer {

/// Whether nearly all light leaves the surface in one direction, or two.
inline bool is_mirror_or_clear(const SurfaceMaterial& m) {
  constexpr float kSmooth = 0.1f;    // perceptual roughness
  constexpr float kDiffuse = 0.05f;  // share of the scattered light
  return m.roughness * m.roughness + m.anisotropy * m.anisotropy <= kSmooth * kSmooth &&
         (1.0f - m.metallic) * (1.0f - m.transmission) <= kDiffuse && !(m.sheen_color > 0.0f).any();
}

/// Call it where a path has met a surface, after first_hit(). Where all surfaces before were mirrors or
/// clear, this one becomes the guide.
inline void record_guide(PathState& path, const SurfaceInteraction& m, FirstHit& first) {
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

/// The first hit of a path that has met nothing before.
inline FirstHit first_hit(const Hit& hit, const Surface& surface, const PathState& path, const Vec3& origin) {
  FirstHit first = renderer::first_hit(hit, surface, origin);
  first.depth += path.previous.travelled;
  return first;
}

/// Call it before a walk through a medium: a camera's ray has the surface behind the medium as its first hit,
/// whether or not it is scattered on its way.
inline void record_behind(const PathContext& context, const PathState& path, const Ray& ray, const Hit& hit,
                          FirstHit& first) {
  if (!path.is_unscattered() || !hit || path.looks_through(context, hit) || path.is_held_out(context, hit))
    return;
  const SurfaceInteraction m(context.world, ray, hit, path.cone.width + path.cone.spread * hit.t,
                             texture_level_number(path.seed));
  first = first_hit(hit, m.surface, path, context.world.scene.origin);
}

/// Call it where a medium has scattered a path: behind mirrors and clear glass, the last surface becomes the
/// guide, with the colour of the medium; in front of all surfaces, that which record_behind() found.
inline void record_medium(PathState& path, const Color& color, FirstHit& first) {
  if (!path.sees_through) return;
  if (path.surfaces == 0) {
    first.albedo = color;
    first.guide.hit = true;
  }
  first.guide.surface = -1;  // keeps its albedo
  first.guide.albedo = first.guide.tint * color;
  path.sees_through = false;
}

/// Sets the albedo of the path's current surface, from its BSDF.
inline void set_albedo(const PathState& path, const Color& albedo, FirstHit& first) {
  if (path.is_unscattered()) first.albedo = albedo;
  if (path.surfaces == first.guide.surface) first.guide.albedo = first.guide.tint * albedo;
}

/// Call it where a path has left the scene. Behind mirrors and clear glass the sky does not count as a
/// surface.
inline void record_background(const PathState& path, FirstHit& first) {
  first.alpha -= path.background();
  if (path.sees_through) first.guide.hit = false;
}

}  // namespace gatelight::renderer
