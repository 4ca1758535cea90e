#pragma once
// A scene with all that rays need of it.

#include "renderer/surface/accel.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

struct Tracer {
  explicit Tracer(const scene::Scene& s, const AccelOptions& options = {})
      : textures(s),
        coverage(s, textures, media),
        surfaces(s, textures),
        masks(s, {}),
        accel(s, coverage, masks, options) {}

  Hit hit(const Vec3& origin, const Vec3& direction) const {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    Hit result;
    accel.intersect({&ray, 1}, {&result, 1}, false);
    return result;
  }

  Color passed(const Vec3& origin, const Vec3& direction, float t_max, std::uint32_t seed = 0) const {
    const Ray ray{origin, t_max, direction, seed};
    Color result;
    accel.transmittance({&ray, 1}, {&result, 1});
    return result;
  }

  Textures textures;
  Media media;
  Coverage coverage;
  Surfaces surfaces;
  RayMasks masks;
  Accel accel;
};

}  // namespace gatelight::renderer
