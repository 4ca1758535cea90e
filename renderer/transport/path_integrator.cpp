#include "renderer/transport/path_integrator.h"

#include "renderer/film/camera_sample.h"

namespace gatelight::renderer {

bool PathIntegrator::scatter(Walker& path, Ray& ray, const Hit& hit, Color& radiance, FirstHit* first,
                             Scratch& scratch) const {
  const auto add = [&](const Emission& emission) {
    if (emission.any()) radiance += path.carried() * emission.radiance * emission.weight;
  };
  if (!hit) {
    add(path.sky(walk_, ray.direction));
    return false;
  }
  const Meeting m = path.meet(walk_, ray, hit, options_.max_depth);
  if (first) *first = first_hit(hit, m.surface, walk_.world.scene.origin);
  add(m.emission);
  if (!m.bsdf) return false;
  if (first) first->albedo = m.bsdf->albedo();

  const LightAt at = path.light_at(walk_, m, *m.bsdf);
  const Color contribution = path.carried() * at.value.value * at.light.radiance * at.weight;
  if ((contribution > 0.0f).any()) {
    scratch.shadow_rays.push_back(shadow_ray(m.surface, at.light, path.seed));
    scratch.pending.push_back({contribution, path.index});
  }
  std::optional<Drawn> drawn = path.draw(m, *m.bsdf);
  return drawn && path.survives(options_.min_depth, *drawn) && path.advance(walk_, m, *drawn);
}

void PathIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                           std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch) const {
  scratch.paths.resize(samples.size());
  scratch.rays.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    scratch.paths[i] = Walker(samples[i], i);
    scratch.rays[i] = samples[i].ray();
    results[i] = {};
    if (!first_hits.empty()) first_hits[i] = {};
  }
  trace_waves(
      walk_.world, {}, scratch, counts,
      [&](Walker& path, Ray& ray, const Hit& hit) {
        FirstHit* const first = path.surfaces == 0 && !first_hits.empty() ? &first_hits[path.index] : nullptr;
        return scatter(path, ray, hit, results[path.index].radiance, first, scratch);
      },
      [&](const PendingLight& light, const Color& transmittance) {
        results[light.index].radiance += light.contribution * transmittance;
      });
}

}  // namespace gatelight::renderer
