#pragma once
// The values that the output variables keep of a primary hit, for all integrators.

#include "renderer/film/camera_sample.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// The position is in the file's coordinates. `origin` is the scene's origin.
inline FirstHit first_hit(const Hit& hit, const Surface& surface, const Vec3& origin) {
  FirstHit first;
  first.hit = true;
  first.albedo = surface.material.base_color;
  first.normal = surface.shading_normal;
  first.position = origin + surface.position;
  first.depth = hit.t;
  first.instance = hit.instance;
  first.primitive = hit.primitive;
  return first;
}

}  // namespace gatelight::renderer
