#include "bench/tracing_only.h"

#include <benchmark/benchmark.h>

#include <algorithm>

#include "renderer/sampling/warp.h"

namespace gatelight::bench {

TracingOnly::TracingOnly(const WorldFixture& world) : bare_(world.bare()) {
  for (const scene::Instance& instance : world.scene.instances) {
    if (!world.scene.material_of(instance).emits()) continue;
    const std::size_t count = world.scene.mesh_of(instance).triangles.size();
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::array<Vec3, 3> p = scene::world_triangle(world.scene, instance, t);
      light_points_.push_back((p[0] + p[1] + p[2]) / 3.0f);
    }
  }
}

std::uint64_t TracingOnly::trace(std::span<const renderer::CameraSample> samples) const {
  std::uint64_t rays = 0;
  renderer::EmbreeQuery query(false);
  const RTCScene scene = bare_.scene();
  for (const renderer::CameraSample& sample : samples) {
    Vec3 origin = sample.camera_ray.ray.origin;
    Vec3 direction = sample.camera_ray.ray.direction;
    std::uint32_t seed = sample.seed;
    const auto random = [&] {
      seed = renderer::hash(seed + 0x9e3779b9u);
      return renderer::sampling::to_unit_float(seed);
    };
    for (int depth = 0; depth < kMaxDepth; ++depth) {
      RTCRayHit ray = to_embree(origin, direction, 1e-4f, kInfinity);
      query.intersect(scene, ray);
      ++rays;
      if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
      Vec3 n = Vec3(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).normalized();
      if (n.dot(direction) > 0.0f) n = -n;
      origin += direction * ray.ray.tfar + n * 1e-4f;
      Vec3 to_light(0.2f, 1.0f, 0.1f);
      float t_max = kInfinity;
      if (!light_points_.empty()) {
        const std::size_t i = static_cast<std::size_t>(random() * static_cast<float>(light_points_.size()));
        to_light = light_points_[std::min(i, light_points_.size() - 1)] - origin;
        t_max = 0.999f;
      }
      if (to_light.dot(n) > 0.0f) {
        RTCRayHit shadow = to_embree(origin, to_light, 0.0f, t_max);
        query.occluded(scene, shadow.ray);
        benchmark::DoNotOptimize(shadow.ray.tfar);
        ++rays;
      }
      const float u = random();
      direction = renderer::Basis(n).to_world(renderer::sample_cosine_hemisphere({u, random()}));
    }
  }
  return rays;
}

}  // namespace gatelight::bench
