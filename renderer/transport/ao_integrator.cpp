#include "renderer/transport/ao_integrator.h"

#include "renderer/film/camera_sample.h"
#include "renderer/transport/waves.h"

namespace gatelight::renderer {

void AoIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                         std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch,
                         const Elsewhere& elsewhere) const {
  auto& [rays, hits, occlusion] = scratch;
  rays.resize(samples.size());
  hits.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) rays[i] = samples[i].ray();
  counts.camera += samples.size();
  {
    const TraceTimer timer(counts);
    world_.accel.intersect(rays, hits, true);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    prefetch(world_.surfaces, hits, i);
    results[i].radiance = Color::Ones();
    if (!first_hits.empty()) first_hits[i] = {};
    const Hit& hit = hits[i];
    if (!hit || world_.catches(hit.instance)) {
      if (!first_hits.empty()) first_hits[i].alpha = 0.0f;
      if (world_.separate_background) results[i].radiance = Color::Zero();
      continue;
    }
    if (world_.holds_out(hit.instance)) {
      if (!first_hits.empty()) first_hits[i].alpha = 0.0f;
      results[i].radiance = Color::Zero();
      continue;
    }
    const RayCone& cone = samples[i].camera_ray.cone;
    const Surface surface =
        world_.surfaces.at(hit, rays[i].direction, cone.width + cone.spread * hit.t, 0.5f);
    if (!first_hits.empty()) {
      first_hits[i] = first_hit(hit, surface, world_.scene.origin);
      first_hits[i].depth += samples[i].camera_ray.begin;
    }
    if (elsewhere && elsewhere(i, hit, surface, rays[i])) continue;
    if (!occlusion.add(surface, samples[i], distance_, i)) results[i].radiance = Color::Zero();
  }
  occlusion.trace(world_, counts, [&](std::size_t i, const Color& open) { results[i].radiance = open; });
}

}  // namespace gatelight::renderer
