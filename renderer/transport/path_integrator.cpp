#include "renderer/transport/path_integrator.h"

#include "renderer/transport/guide_surface.h"

namespace gatelight::renderer {

/// Adds a light sample unless it is black or roulette ends it.
template <class MakeRay>
void PathIntegrator::add_light(const PathState& path, const Color& contribution, std::uint32_t light,
                               MakeRay make_ray, Scratch& scratch) {
  const float weight = path.shadow_weight(contribution.maxCoeff(), path.contribution_threshold);
  if (!(weight > 0.0f)) return;
  scratch.shadow_rays.push_back(make_ray());
  scratch.pending.push_back({contribution * weight, path.index, light});
}

PathBlock* PathIntegrator::scatter(std::uint32_t number, PathState& path, Ray& ray, const Hit& hit,
                                   Color& radiance, FirstHit* first, Scratch& scratch) const {
  const LightGroups& groups = walk_.world.light_groups;
  // `group` returns the light group of the emission.
  const auto add = [&](const Emission& emission, const auto& group) {
    if (!emission.any()) return;
    const Color light = path.carried() * emission.radiance * emission.weight;
    radiance += light;
    if (!groups.empty()) scratch.parts[path.index * groups.size() + group()] += light;
  };
  if (!hit || path.looks_through(walk_, hit)) {
    if (first) record_background(path, *first);
    const Emission sky = path.sky(walk_, ray.direction);
    add(sky, [&] { return groups.of_environment(); });
    return nullptr;
  }
  SurfaceInteraction m = path.intersect(walk_, ray, hit, options_.max_depth);
  if (first && path.surfaces == 0) *first = first_hit(hit, m.surface, walk_.world.scene.origin);
  if (first) record_guide(path, m, *first);
  add(m.emission, [&] { return groups.of_instance(hit.instance); });
  if (m.ends) return nullptr;
  if (path.shades_wide(m)) {
    path.wait(m, number, options_.min_depth, scratch.blocks[0]);
    return &scratch.blocks[0];
  }
  const Bsdf& bsdf = m.set_up_bsdf();
  if (first) set_albedo(path, bsdf.albedo(), *first);

  const NeeSample at = path.sample_light(walk_, m, bsdf);
  const Color contribution = path.carried() * at.value.value * at.light.radiance * at.weight;
  add_light(
      path, contribution, at.light.light, [&] { return shadow_ray(m.surface, at.light, path.seed); },
      scratch);
  std::optional<DirectionSample> sampled = path.sample_bsdf(m, bsdf);
  if (sampled && path.survives(options_.min_depth, *sampled) && path.advance(walk_, m, *sampled))
    scratch.go_on(number, ray);
  return nullptr;
}

void PathIntegrator::shade(PathBlock& block, std::span<FirstHit> first_hits, Scratch& scratch) const {
  const ShadingBlock& points = block.points;
  walk_.shading.scatter(block.points);
  for (int lane = 0; lane < points.count; ++lane) {
    const std::uint32_t number = block.path[lane];
    PathState& path = scratch.paths[scratch.path_of[number]];
    if (!first_hits.empty()) set_albedo(path, lane_color(points.albedo, lane), first_hits[path.index]);
    const Color contribution = path.carried() * lane_color(points.direct, lane) *
                               path.transmittance(walk_, points.shadow_length[lane]);
    add_light(
        path, contribution, points.light[lane], [&] { return shadow_ray_at(points, lane); }, scratch);
    if (!points.alive[lane]) continue;
    Ray next;
    if (path.advance(block, lane, direction_sample_at(points, lane), scratch.hits[number].t, next))
      scratch.go_on(number, next);
  }
}

void PathIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                           std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch) const {
  scratch.paths.resize(samples.size());
  scratch.rays.resize(samples.size());
  const LightGroups& groups = walk_.world.light_groups;
  scratch.parts.assign(groups.size() * samples.size(), Color::Zero());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    scratch.paths[i] = PathState(walk_.world, samples[i], i);
    scratch.rays[i] = samples[i].ray();
    results[i] = {};
    if (!first_hits.empty()) first_hits[i] = {};
  }
  trace_waves(
      walk_.world, {}, scratch, counts,
      [&](std::uint32_t number, PathState& path, Ray& ray, const Hit& hit) {
        FirstHit* const first = first_hits.empty() ? nullptr : &first_hits[path.index];
        return scatter(number, path, ray, hit, results[path.index].radiance, first, scratch);
      },
      [&](PathBlock& block) { shade(block, first_hits, scratch); },
      [&](const PendingLight& light, const Color& transmittance) {
        const Color arrived = light.contribution * transmittance;
        results[light.index].radiance += arrived;
        if (groups.empty()) return;
        const std::size_t group = groups.of_light(walk_.world.lights.triangles(), light.light);
        scratch.parts[light.index * groups.size() + group] += arrived;
      });
}

}  // namespace gatelight::renderer
