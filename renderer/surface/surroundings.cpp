#include "renderer/surface/surroundings.h"

#include <algorithm>
#include <cmath>

#include "scene/nested_volumes.h"

namespace gatelight::renderer {

Surroundings::Surroundings(const scene::Scene& scene, const Media& media, const Accel& accel,
                           const Surfaces& surfaces, const Box& places)
    : scene_(scene), accel_(accel), surfaces_(surfaces) {
  const std::vector<scene::EnclosedBody> found = scene::find_bodies_at(scene, places);
  if (found.empty()) return;
  body_of_.assign(scene.instances.size(), kNone);
  for (const scene::EnclosedBody& body : found) {
    const std::uint32_t first = body.instances.front();
    for (const auto* surfaces_of_body : {&body.instances, &body.closing}) {
      for (const std::uint32_t i : *surfaces_of_body) body_of_[i] = static_cast<int>(bodies_.size());
    }
    bodies_.push_back({media.volume_of(first), first});
  }
}

StartMedium Surroundings::at(const Vec3& point, float time) const {
  StartMedium start;
  if (empty()) return start;
  // The first surface of a body tells whether the point is inside it.
  std::vector<char> met(bodies_.size(), 0);
  std::size_t unmet = bodies_.size();
  Ray ray;
  ray.origin = point;
  ray.direction = Vec3(0.48f, 0.64f, 0.6f);
  ray.seed = kMeetsAll;
  ray.time = time;
  constexpr int kMaxSurfaces = 4096;
  for (int i = 0; i < kMaxSurfaces && unmet > 0; ++i) {
    const Hit hit = accel_.intersect(ray);
    if (!hit) break;
    const Surface surface = surfaces_.at(hit, ray.direction, 0.0f, 0.0f);
    if (const int number = body_of_[hit.instance]; number != kNone) {
      const Body& body = bodies_[static_cast<std::size_t>(number)];
      char& known = met[static_cast<std::size_t>(number)];
      if (!known && !surface.front) {
        if (body.volume == scene::kNoVolume) start.body = body.instance;
        if (body.volume != scene::kNoVolume) start.volumes.enter(body.volume);
      }
      unmet -= known ? 0 : 1;
      known = 1;
    }
    // The offset is along the ray: smooth surfaces are raised for shading.
    const float cosine = std::abs(surface.geometric_normal.dot(ray.direction));
    ray.origin += ray.direction * (hit.t + 2.0f * surface.offset / std::max(cosine, 1e-2f));
  }
  return start;
}

}  // namespace gatelight::renderer
