#pragma once
// Single shadow rays.

#include "renderer/transport/world.h"

namespace gatelight::testing {

/// Transmittance of a shadow ray of this length along -z, from height z.
inline Color passed_down(const renderer::World& world, float z, float length) {
  renderer::Ray ray;
  ray.origin = Vec3(0.1f, 0.2f, z);
  ray.direction = Vec3(0, 0, -1);
  ray.t_max = length;
  Color result;
  world.accel.transmittance({&ray, 1}, {&result, 1});
  return result;
}

}  // namespace gatelight::testing
