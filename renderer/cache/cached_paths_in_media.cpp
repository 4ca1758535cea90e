// Paths in media that scatter, and the diffuse lobes of their surfaces for the render passes.

#include "renderer/cache/cached_paths.h"
#include "renderer/transport/guide_surface.h"
#include "renderer/transport/medium_walk.h"

namespace gatelight::renderer {

[[gnu::noinline, gnu::cold]] bool CachedPaths::walk(Path& path, Ray& ray, Hit& hit, const PathPlan& plan,
                                                    PathBatch& batch, FirstHit* first, RayCounts& counts,
                                                    Scratch& scratch) const {
  const bool first_event = path.depth == 0;
  const Color throughput = path.throughput;
  if (first) record_behind(context_, path, ray, hit, *first);
  const MediumWalk walk = walk_medium(
      context_, path, ray, hit, plan.max_depth, counts,
      [&](const Color& arriving, const Ray& shadow, std::uint32_t, int event) {
        const Color light = arriving * path.scale();
        const float weight =
            plan.contribution_threshold > 0.0f
                ? 1.0f
                : path.shadow_weight((throughput * light).maxCoeff(), path.contribution_threshold);
        if (!(weight > 0.0f)) return;
        scratch.shadow_rays.push_back(shadow);
        Pending& pending = scratch.pending.emplace_back(Pending{
            path.vertex, path.weights.scattered * light * weight, path.weights.cached * light * weight});
        pending.of_medium = true;
        pending.path = path.index;
        pending.lobes = {.rest = LobeShare::Rest::volume};
        pending.indirect = !first_event || event > 1;
      });
  path.weights *= walk.factor;
  if (walk.events == 0) return walk.alive;
  // Emission that the path finds now is light that the medium has scattered.
  path.weights.emission = path.weights.scattered;
  path.through_medium = true;
  path.wide_events += 1;
  path.spread += walk.spread;
  if (first) record_medium(path, path.inside->color, *first);
  if (batch.parts.any_passes() && first_event) batch.parts.scatter_in_medium(path.index, walk.events);
  return walk.alive;
}

void CachedPaths::shade_diffuse(const PathBlock& block, bool all_lobes, PathBlock& copy) const {
  copy = block;
  if (all_lobes) {
    diffuse_shading_->scatter(copy);
  } else if (separate_delta_) {
    diffuse_shading_->delta_light(copy);
  } else {
    diffuse_shading_->albedo(copy);
  }
}

}  // namespace gatelight::renderer
