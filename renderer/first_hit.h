#pragma once
// What the output variables keep of a primary hit: one definition for all integrators.

#include "renderer/camera_sample.h"
#include "renderer/surface.h"

namespace gatelight::renderer {

inline FirstHit first_hit(const Hit& hit, const Surface& surface) {
  FirstHit first;
  first.hit = true;
  first.albedo = surface.material.base_color;
  first.normal = surface.shading_normal;
  first.position = surface.position;
  first.depth = hit.t;
  first.instance = hit.instance;
  first.primitive = hit.primitive;
  return first;
}

}  // namespace gatelight::renderer
