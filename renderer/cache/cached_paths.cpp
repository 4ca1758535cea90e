#include "renderer/cache/cached_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/cache/scene_layout.h"
#include "renderer/shading/lobe_widths.h"
#include "renderer/transport/guide_surface.h"

namespace gatelight::renderer {
namespace {

/// Where the cache answers the wide lobes, the narrow ones are followed with a probability of this factor
/// times the square root of their throughput. A reflection that is visible in a varnish of 4 % is always
/// followed once and rarely twice: one ray and one query cost less than the noise of leaving them out. After
/// a wide bounce other noise is larger.
constexpr Roulette kPrimaryNarrow{5.0f, 1.0f}, kLaterNarrow{1.5f, 1.0f};

const Roulette& narrow_roulette(const PathPlan& plan) {
  return plan.query_at == QueryAt::primary ? kPrimaryNarrow : kLaterNarrow;
}

/// Light at a vertex is summed up in units of the path's start. With hundreds of nested media between the
/// two, single precision cannot represent both, and the vertex makes no record.
constexpr float kMinScale = 1e-20f;

}  // namespace

StoredSurfaces::StoredSurfaces(const scene::Scene& scene, std::span<const neural::Sides> sides)
    : all_(false), stored_(2 * scene.instances.size(), 0) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const bool alike = possible_sides(scene, scene.instances[i]) != neural::Sides::both;
    for (const std::uint32_t side : {0u, 1u}) {
      const bool stored = alike ? sides[i] != neural::Sides::none : has_side(sides[i], side);
      stored_[neural::surface_index(i, side)] = stored ? 1 : 0;
    }
  }
}

std::uint32_t CachedPaths::side_at(const Hit& hit, bool front) const {
  return side_of(front, context_.world.scene.instances[hit.instance].swaps_handedness);
}

bool CachedPaths::may_record(const Path& path, const PathPlan& plan) const {
  return plan.records && (plan.most_records == kNone || path.records < plan.most_records);
}

bool CachedPaths::ends_here(const Path& path, const PathPlan& plan) const {
  if (plan.end_after_records != kNone) return !path.to_its_end && path.records >= plan.end_after_records;
  return ends_at(path, plan.query_at);
}

bool CachedPaths::ends_at(const Path& path, QueryAt place) const {
  switch (place) {
    case QueryAt::primary:
      return true;
    case QueryAt::gather:
      return path.wide_events > 0;
    case QueryAt::spread:
      return path.spread * path.spread > options_.spread_threshold * path.first_spread;
    case QueryAt::none:
      break;
  }
  return false;
}

void CachedPaths::add_emission(const Path& path, const Emission& found, bool background,
                               PathBatch& batch) const {
  if (!found.any()) return;
  const Color emission = found.radiance * (found.weight * path.scale());
  if (path.vertex == kNone) {
    const Color light = path.weights.emission * emission;
    batch.emission[path.index] += light;
    if (batch.parts.any_passes()) batch.parts.add_found(path.index, path.depth, background, light);
    return;
  }
  PathVertex& from = batch.vertices[static_cast<std::size_t>(path.vertex)];
  from.direct += path.weights.emission * emission;
  if (batch.parts.any_passes() && from.previous == kNone)
    batch.parts.add_found(path.index, path.through_medium ? 2 : path.depth, background,
                          from.link * path.weights.emission * emission);
  if (from.record != kNone && (options_.cached.emission() || path.through_medium))
    batch.target(from.record) += path.weights.cached * emission;
}

PathBlock* CachedPaths::scatter(std::uint32_t number, Path& path, Ray& ray, Hit& hit, const PathPlan& plan,
                                PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& counts,
                                Scratch& scratch) const {
  FirstHit* const first = first_hits.empty() ? nullptr : &first_hits[path.index];
  if (path.inside && path.inside->scatters && !walk(path, ray, hit, plan, batch, first, counts, scratch))
    return nullptr;
  if (hit && path.is_held_out(context_, hit)) {
    if (first) record_background(path, *first);
    return nullptr;
  }
  if (!hit || path.looks_through(context_, hit)) {
    if (first) record_background(path, *first);
    const Emission sky = path.sky(context_, ray.direction);
    add_emission(path, sky, true, batch);
    return nullptr;
  }
  SurfaceInteraction m = path.intersect(context_, ray, hit, plan.max_depth);
  path.weights *= m.passed;
  if (first && path.is_unscattered()) *first = first_hit(hit, m.surface, path, context_.world.scene.origin);
  if (first) record_guide(path, m, *first);
  add_emission(path, m.emission, false, batch);
  if (m.ends) return nullptr;

  if (plan.query_at == QueryAt::spread || plan.samples_at == QueryAt::spread) {
    // Mueller et al. 2021, equations 3 and 4; a direction of a delta lobe does not spread.
    const float distance = path.previous.travelled + hit.t;
    const float cosine = std::max(std::abs(m.surface.geometric_normal.dot(m.wo)), 1e-4f);
    if (path.surfaces == 0) {
      path.first_spread = distance * distance * kInvFourPi / cosine;
    } else if (!path.previous.delta && path.previous.pdf > 0.0f) {
      path.spread += distance / std::sqrt(path.previous.pdf * cosine);
    }
  }
  const bool kernels = path.kernels_shade(m);
  const BlockKind kind = kind_of(path, m, kernels, plan);
  int min_depth = plan.min_depth;
  // Where a path ends in the cache, Russian roulette applies at every depth (narrow_roulette), or never.
  if (kind != kContinue) min_depth = options_.cached.emission() ? path.depth : kNoDepthLimit;
  PathBlock& block = scratch.block_of(kind, kernels);
  path.enqueue(context_, m, number, min_depth, block);
  return &block;
}

CachedPaths::BlockKind CachedPaths::kind_of(const Path& path, const SurfaceInteraction& m, bool kernels,
                                            const PathPlan& plan) const {
  if (path.emission_only || !ends_here(path, plan)) return kContinue;
  if (!stored_(neural::surface_index(m.hit.instance, side_at(m.hit, m.surface.front)))) return kContinue;
  switch (lobe_widths(m.surface, m.wo, kernels, options_.min_roughness)) {
    case LobeWidths::wide:
      return kCacheOnly;
    case LobeWidths::both:
      return kCacheAndNarrow;
    case LobeWidths::narrow:
      break;
  }
  return kContinue;
}

void CachedPaths::shade(PathBlock& block, const PathPlan& plan, PathBatch& batch,
                        std::span<FirstHit> first_hits, Scratch& scratch) const {
  const auto kind = static_cast<BlockKind>(scratch.kind_of(block));
  const bool all_lobes = kind == kContinue || !options_.cached.emission();
  if (plan.passes) shade_diffuse(block, all_lobes, scratch.diffuse);
  if (all_lobes) {
    context_.shading.scatter(block);
  } else if (separate_delta_) {
    context_.shading.delta_light(block);
  } else if (kind == kCacheAndNarrow) {
    context_.shading.scatter_narrow(block, narrow_roulette(plan));
  } else {
    context_.shading.albedo(block);
  }
  const ShadingBlock& points = block.points;
  std::int32_t vertices[ShadingBlock::kWidth];
  for (int lane = 0; lane < points.count; ++lane) {
    Path& path = scratch.paths[scratch.path_of[block.path[lane]]];
    if (!first_hits.empty()) set_albedo(path, lane_color(points.albedo, lane), first_hits[path.index]);
    if (kind == kContinue) {
      continue_from(path, block, lane, plan, batch, scratch);
      continue;
    }
    const SurfacePoint point =
        point_at(block, lane, scratch.hits[block.path[lane]],
                 lane_color(kind == kCacheAndNarrow ? points.wide_albedo : points.albedo, lane));
    vertices[lane] = add_query_vertex(path, point, batch);
    const ShadingBlock& diffuse = scratch.diffuse.points;
    if (plan.passes)
      batch.answer_lobes.push_back({share_of(lane_color(diffuse.wide_albedo, lane), point.albedo)});
    const bool guides = seeks_guide(path, batch);
    if (guides) set_guide(path, point, true, vertices[lane], batch);
    if (all_lobes || separate_delta_)
      add_light(path, block, lane, false, guides, vertices[lane],
                plan.passes ? share_of_light(diffuse, lane) : LobeShare{}, plan, scratch);
    if (all_lobes && points.alive[lane])
      follow_direct(path, block, lane, kind == kCacheAndNarrow, vertices[lane], batch, scratch);
  }
  if (all_lobes || kind != kCacheAndNarrow) return;
  if (separate_delta_) context_.shading.scatter_narrow(block, narrow_roulette(plan));
  for (int lane = 0; lane < points.count; ++lane) {
    Path& path = scratch.paths[scratch.path_of[block.path[lane]]];
    if (!separate_delta_ || !points.light_is_delta[lane])
      add_light(path, block, lane, false, false, vertices[lane],
                {Color::Zero(), rest_of(plan.passes && light_is_behind(points, lane))}, plan, scratch);
    if (!points.alive[lane]) continue;
    const DirectionSample sampled = direction_sample_at(block, lane);
    const LobeShare lobes{Color::Zero(), rest_of(sampled.transmitted)};
    follow(path, block, lane, sampled, {sampled.weight, sampled.weight}, vertices[lane], {lobes, lobes},
           batch, scratch);
  }
}

SurfacePoint CachedPaths::point_at(const PathBlock& block, int lane, const Hit& hit,
                                   const Color& wide_albedo) const {
  const ShadingBlock& p = block.points;
  return {hit,
          side_at(hit, block.front[lane]),
          lane_vector(p.wo, lane),
          lane_vector(p.position, lane),
          lane_vector(p.shading_normal, lane),
          wide_albedo,
          p.roughness[lane]};
}

bool CachedPaths::seeks_guide(const Path& path, const PathBatch& batch) {
  return !batch.guides.empty() && batch.guides[path.index].vertex == kNone;
}

void CachedPaths::set_guide(const Path& path, const SurfacePoint& point, bool stored, std::int32_t vertex,
                            PathBatch& batch) const {
  PathGuide& guide = batch.guides[path.index];
  guide.vertex = vertex;
  if (!stored || !worth_caching(point.albedo)) return;
  guide.reflectance = cache_reflectance(point.albedo) * path.scale();
  const std::int32_t query = batch.vertices[static_cast<std::size_t>(vertex)].query;
  guide.query = query != kNone ? query : static_cast<std::int32_t>(batch.queries.size());
  if (query == kNone) batch.queries.push_back(point);
}

std::int32_t CachedPaths::add_query_vertex(const Path& path, const SurfacePoint& point,
                                           PathBatch& batch) const {
  const auto index = static_cast<std::int32_t>(batch.vertices.size());
  PathVertex& v = batch.vertices.emplace_back(
      PathVertex{path.vertex, path.index, path.weights.scattered, path.weights.cached});
  if (!worth_caching(point.albedo)) return index;
  v.reflectance = cache_reflectance(point.albedo) * path.scale();
  v.query = static_cast<std::int32_t>(batch.queries.size());
  batch.queries.push_back(point);
  if (batch.first_queries[path.index] == kNone) batch.first_queries[path.index] = v.query;
  return index;
}

std::int32_t CachedPaths::add_vertex(Path& path, const SurfacePoint& point, bool& record,
                                     const PathPlan& plan, PathBatch& batch) const {
  record =
      record && worth_caching(point.albedo) && path.scale() > kMinScale && path.scale() < 1.0f / kMinScale;
  const auto index = static_cast<std::int32_t>(batch.vertices.size());
  PathVertex& v = batch.vertices.emplace_back(
      PathVertex{path.vertex, path.index, path.weights.scattered, path.weights.cached});
  if (!record) return index;
  v.reflectance = cache_reflectance(point.albedo) * path.scale();
  v.record = static_cast<std::int32_t>(batch.records.size());
  batch.records.push_back(point);
  batch.targets.resize(3 * batch.records.size(), 0.0f);
  if (path.records == 0) batch.first_records[path.index] = v.record;
  path.records += 1;
  if (!batch.ends.empty() && batch.ends[path.index] == kNone && ends_at(path, plan.samples_at))
    batch.ends[path.index] = index;
  return index;
}

void CachedPaths::continue_from(Path& path, const PathBlock& block, int lane, const PathPlan& plan,
                                PathBatch& batch, Scratch& scratch) const {
  const ShadingBlock& p = block.points;
  if (path.emission_only) {
    if (!p.alive[lane]) return;
    const DirectionSample sampled = direction_sample_at(block, lane);
    follow(path, block, lane, sampled, {sampled.weight, sampled.weight}, kNone, {}, batch, scratch);
    return;
  }
  const Hit& hit = scratch.hits[block.path[lane]];
  const Color wide_albedo = lane_color(p.wide_albedo, lane);
  const SurfacePoint point = point_at(block, lane, hit, wide_albedo);
  const bool stored = stored_(neural::surface_index(hit.instance, point.side));
  const bool wide = (wide_albedo > 0.0f).any();
  if (!stored && wide && ends_here(path, plan)) ++batch.unstored_hits;
  bool record = stored && wide && may_record(path, plan);
  const std::int32_t index = add_vertex(path, point, record, plan, batch);
  const ShadingBlock& diffuse = scratch.diffuse.points;
  if (plan.passes)
    batch.answer_lobes.push_back({share_of(lane_color(diffuse.wide_albedo, lane), wide_albedo)});
  const bool guides = wide && seeks_guide(path, batch);
  if (guides) set_guide(path, point, stored, index, batch);
  add_light(path, block, lane, record, guides, index,
            plan.passes ? share_of_light(diffuse, lane) : LobeShare{}, plan, scratch);
  if (!p.alive[lane]) return;
  const DirectionSample sampled = direction_sample_at(block, lane);
  if (!sampled.delta && !(sampled.spread < options_.min_roughness * options_.min_roughness))
    path.wide_events += 1;
  const Color cached = record ? lane_color(p.wide_weight, lane) : Color(Color::Zero());
  const LobeShare lobes = plan.passes ? share_of_direction(diffuse, lane) : LobeShare{};
  follow(path, block, lane, sampled, {sampled.weight, sampled.weight, cached}, index, {lobes, lobes}, batch,
         scratch);
}

void CachedPaths::add_light(const Path& path, const PathBlock& block, int lane, bool record, bool guides,
                            std::int32_t vertex, const LobeShare& lobes, const PathPlan& plan,
                            Scratch& scratch) const {
  const ShadingBlock& p = block.points;
  if (!(lane_color(p.direct, lane) > 0.0f).any()) return;
  const auto [shadow, transmittance] =
      path.shadow_ray(context_, block, lane, scratch.hits[block.path[lane]].instance);
  const Color passed = transmittance * path.scale();
  const Color direct = lane_color(p.direct, lane) * passed;
  const float weight =
      plan.contribution_threshold > 0.0f
          ? path.shadow_weight(direct.maxCoeff(),
                               plan.contribution_threshold *
                                   cache_reflectance(lane_color(p.wide_albedo, lane)).maxCoeff() *
                                   path.scale())
          : path.shadow_weight((path.throughput * direct).maxCoeff(), path.contribution_threshold);
  if (!(weight > 0.0f)) return;
  const bool delta = p.light_is_delta[lane] != 0, holds = options_.cached.light_sample(delta);
  const Color wide = lane_color(p.wide_direct, lane) * passed * weight;
  const Color none = Color::Zero();
  scratch.shadow_rays.push_back(shadow);
  scratch.pending.push_back({vertex, direct * weight, record && holds ? wide : none,
                             guides && delta && !holds ? wide : none, lobes});
}

void CachedPaths::follow_direct(Path& path, const PathBlock& block, int lane, bool narrow,
                                std::int32_t vertex, PathBatch& batch, Scratch& scratch) const {
  const DirectionSample sampled = direction_sample_at(block, lane);
  Color scattered = Color::Zero();
  if (sampled.delta) {
    scattered = sampled.weight;
  } else if (narrow) {
    scattered = (sampled.weight - lane_color(block.points.wide_weight, lane)).max(0.0f);
  }
  path.emission_only = !(scattered > 0.0f).any();
  LightParts::FirstScattering lobes;
  if (batch.parts.any_passes())
    lobes = {share_of_direction(scratch.diffuse.points, lane), {Color::Zero(), rest_of(sampled.transmitted)}};
  follow(path, block, lane, sampled, {sampled.weight, scattered}, vertex, lobes, batch, scratch);
}

void CachedPaths::follow(Path& path, const PathBlock& block, int lane, const DirectionSample& sampled,
                         const VertexWeights& weights, std::int32_t vertex,
                         const LightParts::FirstScattering& lobes, PathBatch& batch, Scratch& scratch) const {
  if (sampled.through_pane) {
    // Light from behind the pane belongs to the vertex before the pane, whose light samples pass it too.
    path.weights *= weights.emission;
  } else {
    if (batch.parts.any_passes() && path.vertex == kNone) {
      LightParts::FirstScattering& first = batch.parts.first_scattering(path.index);
      if (!first.in_medium) first = lobes;
    }
    path.vertex = vertex;
    path.through_medium = false;
    path.weights = weights;
  }
  const std::uint32_t number = block.path[lane];
  Ray next;
  if (path.advance(context_, block, lane, sampled, scratch.hits[number], next))
    scratch.push_next_ray(number, next);
}

void CachedPaths::trace(std::span<const PathStart> starts, std::span<const Hit> hits, const PathPlan& plan,
                        PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& counts,
                        Scratch& scratch) const {
  batch.begin(starts.size());
  if (plan.passes) batch.parts.begin(options_.passes, 0, starts.size());
  if (plan.guides) batch.guides.resize(starts.size());
  if (plan.samples_at != QueryAt::none) batch.ends.resize(starts.size(), kNone);
  scratch.paths.resize(starts.size());
  scratch.rays.resize(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    scratch.paths[i] = Path(context_.world, starts[i], i);
    scratch.rays[i] = starts[i].sample.ray();
    if (!first_hits.empty()) first_hits[i] = {};
  }
  trace_waves(
      context_.world, hits, scratch, counts,
      [&](std::uint32_t number, Path& path, Ray& ray, Hit& hit) {
        return scatter(number, path, ray, hit, plan, batch, first_hits, counts, scratch);
      },
      [&](PathBlock& block) { shade(block, plan, batch, first_hits, scratch); },
      [&](const Pending& light, const Color& transmittance) {
        if (light.vertex == kNone) {  // between the camera and the first surface
          const Color arrived = light.direct * transmittance;
          batch.emission[light.path] += arrived;
          if (batch.parts.any_passes()) batch.parts.add(light.path, light.lobes, !light.indirect, arrived);
          return;
        }
        PathVertex& v = batch.vertices[static_cast<std::size_t>(light.vertex)];
        v.direct += light.direct * transmittance;
        if (batch.parts.any_passes() && v.previous == kNone) {
          const Color arrived = v.link * light.direct * transmittance;
          if (light.of_medium || batch.parts.first_scattering(v.path).in_medium) {
            batch.parts.add_indirect(v.path, arrived);
          } else {
            batch.parts.add(v.path, light.lobes, true, arrived);
          }
        }
        if (v.record != kNone) batch.target(v.record) += light.cached * transmittance;
        if (!batch.guides.empty() && batch.guides[v.path].vertex == light.vertex)
          batch.guides[v.path].separate += light.separate * transmittance;
      });
}

}  // namespace gatelight::renderer
