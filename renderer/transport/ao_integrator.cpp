#include "renderer/transport/ao_integrator.h"

#include "renderer/film/first_hit.h"
#include "renderer/transport/occlusion.h"
#include "renderer/transport/trace_timer.h"

namespace gatelight::renderer {

void AoIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                         std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch) const {
  scratch.rays.resize(samples.size());
  scratch.hits.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    scratch.rays[i] = samples[i].camera_ray.ray;
    scratch.rays[i].seed = samples[i].seed;
  }
  counts.camera += samples.size();
  {
    const TraceTimer timer(counts);
    world_.accel.intersect(scratch.rays, scratch.hits, true);
  }

  scratch.shadow_rays.clear();
  scratch.index.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    results[i].radiance = Color::Ones();
    if (!first_hits.empty()) first_hits[i] = {};
    const Hit& hit = scratch.hits[i];
    if (!hit) continue;
    const Ray& camera_ray = scratch.rays[i];
    const RayCone& cone = samples[i].camera_ray.cone;
    const Surface surface =
        world_.surfaces.at(hit, camera_ray.direction, cone.width + cone.spread * hit.t, 0.5f);
    if (!first_hits.empty()) first_hits[i] = first_hit(hit, surface, world_.scene.origin);
    Ray ray;
    if (!make_occlusion_ray(surface, samples[i], distance_, ray)) {
      results[i].radiance = Color::Zero();
      continue;
    }
    scratch.shadow_rays.push_back(ray);
    scratch.index.push_back(static_cast<std::uint32_t>(i));
  }
  counts.shadow += scratch.shadow_rays.size();
  scratch.transmittance.resize(scratch.shadow_rays.size());
  {
    const TraceTimer timer(counts);
    world_.accel.transmittance(scratch.shadow_rays, scratch.transmittance);
  }
  for (std::size_t i = 0; i < scratch.index.size(); ++i) {
    results[scratch.index[i]].radiance = scratch.transmittance[i];
  }
}

}  // namespace gatelight::renderer
