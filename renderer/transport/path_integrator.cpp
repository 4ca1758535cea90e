#include "renderer/transport/path_integrator.h"

#include "renderer/transport/guide_surface.h"
#include "renderer/transport/medium_walk.h"

namespace gatelight::renderer {

[[gnu::noinline, gnu::cold]] bool PathIntegrator::walk(PathState& path, Ray& ray, Hit& hit, FirstHit* first,
                                                       RayCounts& counts, Scratch& scratch) const {
  const bool first_event = path.depth == 0;
  const Color carried = path.carried();
  if (first) record_behind(context_, path, ray, hit, *first);
  const MediumWalk walk = walk_medium(
      context_, path, ray, hit, options_.max_depth, counts,
      [&](const Color& light, const Ray& shadow, std::uint32_t number, int event) {
        const Color contribution = carried * light;
        const float weight = path.shadow_weight(contribution.maxCoeff(), path.contribution_threshold);
        if (!(weight > 0.0f)) return;
        scratch.shadow_rays.push_back(shadow);
        PendingLight& pending =
            scratch.pending.emplace_back(PendingLight{contribution * weight, path.index, number});
        if (!scratch.parts.any_passes()) return;
        pending.direct = first_event && event == 1;
        pending.lobes = first_event ? LobeShare{.rest = LobeShare::Rest::volume}
                                    : scratch.parts.first_scattering(path.index).scattered;
      });
  if (walk.events == 0) return walk.alive;
  if (first) record_medium(path, path.inside->color, *first);
  if (scratch.parts.any_passes() && first_event) scratch.parts.scatter_in_medium(path.index, walk.events);
  return walk.alive;
}

PathBlock* PathIntegrator::scatter(std::uint32_t number, PathState& path, Ray& ray, Hit& hit, Color& radiance,
                                   FirstHit* first, RayCounts& counts, Scratch& scratch) const {
  if (path.inside && path.inside->scatters && !walk(path, ray, hit, first, counts, scratch)) return nullptr;
  const LightGroups& groups = context_.world.light_groups;
  // `group` returns the light group of the emission.
  const auto add = [&](const Emission& emission, bool background, const auto& group) {
    if (!emission.any()) return;
    const Color light = path.carried() * emission.radiance * emission.weight;
    radiance += light;
    if (!groups.empty()) scratch.parts.add_to_group(path.index, group(), light);
    if (scratch.parts.any_passes()) scratch.parts.add_found(path.index, path.depth, background, light);
  };
  if (hit && path.is_held_out(context_, hit)) {
    if (first) record_background(path, *first);
    return nullptr;
  }
  if (!hit || path.looks_through(context_, hit)) {
    if (first) record_background(path, *first);
    const Emission sky = path.sky(context_, ray.direction);
    add(sky, true, [&] { return groups.of_environment(); });
    return nullptr;
  }
  SurfaceInteraction m = path.intersect(context_, ray, hit, options_.max_depth);
  if (first && path.is_unscattered()) *first = first_hit(hit, m.surface, path, context_.world.scene.origin);
  if (first) record_guide(path, m, *first);
  add(m.emission, false, [&] { return groups.of_instance(hit.instance); });
  if (m.ends) return nullptr;
  PathBlock& block = scratch.block_of(0, path.kernels_shade(m));
  path.enqueue(context_, m, number, options_.min_depth, block);
  return &block;
}

void PathIntegrator::add_light(const PathState& path, const PathBlock& block, int lane,
                               Scratch& scratch) const {
  const ShadingBlock& points = block.points;
  const Color direct = lane_color(points.direct, lane);
  if (!(direct > 0.0f).any()) return;
  auto [shadow, passed] = path.shadow_ray(context_, block, lane, scratch.hits[block.path[lane]].instance);
  LobeShare lobes;
  if (scratch.parts.any_passes() || by_lobe_) lobes = share_of_light(points, lane);
  if (by_lobe_ && context_.has_rules)
    passed *= keep_visible(lobes, context_.world.light_rules.of_light(points.light[lane]).rays);
  const Color contribution = path.carried() * direct * passed;
  const float weight = path.shadow_weight(contribution.maxCoeff(), path.contribution_threshold);
  if (!(weight > 0.0f)) return;
  scratch.shadow_rays.push_back(shadow);
  PendingLight& pending =
      scratch.pending.emplace_back(PendingLight{contribution * weight, path.index, points.light[lane]});
  if (!scratch.parts.any_passes()) return;
  pending.direct = path.depth == 0;
  pending.lobes = pending.direct ? lobes : scratch.parts.first_scattering(path.index).scattered;
}

void PathIntegrator::shade(PathBlock& block, std::span<FirstHit> first_hits, Scratch& scratch) const {
  const ShadingBlock& points = block.points;
  context_.shading.scatter(block);
  for (int lane = 0; lane < points.count; ++lane) {
    const std::uint32_t number = block.path[lane];
    PathState& path = scratch.paths[scratch.path_of[number]];
    if (!first_hits.empty()) set_albedo(path, lane_color(points.albedo, lane), first_hits[path.index]);
    add_light(path, block, lane, scratch);
    if (!points.alive[lane]) continue;
    DirectionSample sampled = direction_sample_at(block, lane);
    LobeShare lobes;
    if (scratch.parts.any_passes() || by_lobe_) lobes = share_of_direction(points, lane);
    if (by_lobe_ && !sampled.through_pane) choose_lobe(lobes, sampled, lobe_number(path.seed));
    if (scratch.parts.any_passes() && path.depth == 0 && !sampled.through_pane) {
      scratch.parts.first_scattering(path.index) = {lobes, lobes};
    }
    Ray next;
    if (path.advance(context_, block, lane, sampled, scratch.hits[number], next))
      scratch.push_next_ray(number, next);
  }
}

void PathIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                           std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch) const {
  scratch.paths.resize(samples.size());
  scratch.rays.resize(samples.size());
  const LightGroups& groups = context_.world.light_groups;
  scratch.parts.begin(options_.passes, groups.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    scratch.paths[i] = PathState(context_.world, samples[i], i);
    scratch.rays[i] = samples[i].ray();
    results[i] = {};
    if (!first_hits.empty()) first_hits[i] = {};
  }
  trace_waves(
      context_.world, {}, scratch, counts,
      [&](std::uint32_t number, PathState& path, Ray& ray, Hit& hit) {
        FirstHit* const first = first_hits.empty() ? nullptr : &first_hits[path.index];
        return scatter(number, path, ray, hit, results[path.index].radiance, first, counts, scratch);
      },
      [&](PathBlock& block) { shade(block, first_hits, scratch); },
      [&](const PendingLight& light, const Color& transmittance) {
        const Color arrived = light.contribution * transmittance;
        results[light.index].radiance += arrived;
        if (!groups.empty()) {
          const std::size_t group = groups.of_light(context_.world.lights.triangles(), light.light);
          scratch.parts.add_to_group(light.index, group, arrived);
        }
        if (scratch.parts.any_passes()) scratch.parts.add(light.index, light.lobes, light.direct, arrived);
      });
}

}  // namespace gatelight::renderer
