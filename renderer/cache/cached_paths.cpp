#include "renderer/cache/cached_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/cache/cached_paths_scratch.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/film/first_hit.h"

namespace gatelight::renderer {
namespace {

/// Where the wide lobes are answered, the narrow ones are followed with this times the root of their
/// throughput: what a varnish of 4 % reflects is always looked at once, as one ray and one question are cheap
/// beside the noise of leaving them out, and rarely twice.
constexpr float kNarrowSurvival = 5.0f;

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

CachedPaths::CachedPaths(const World& world, const RenderOptions& options, const StoredSurfaces& stored)
    : world_(world),
      options_(options),
      stored_(stored),
      held_{options.cache.holds},
      mis_{options.direct, options.mis},
      delta_lights_(world.lights.has_delta()) {}

/// A path at a surface.
struct CachedPaths::Meeting {
  Ray& ray;  ///< that came here; the next one is written over it
  const Hit& hit;
  const Surface& surface;
  const Bsdf& bsdf;
  Vec3 wo;
  Vec3 light_normal;  ///< as light sampling takes it
  std::uint32_t side = 0;
  float cone_width = 0.0f;
  std::uint32_t dimensions = 0;  ///< first of this vertex's

  bool through_pane(const BsdfSample& sample) const {
    return sample.delta && sample.transmitted && surface.material.thin_walled;
  }
};

bool CachedPaths::ends_here(const Path& path, const PathPlan& plan) const {
  if (plan.end_after_records != kNone) return !path.to_its_end && path.records >= plan.end_after_records;
  switch (plan.query_at) {
    case QueryAt::primary:
      return true;
    case QueryAt::gather:
      return path.wide_events > 0;
    case QueryAt::spread:
      return path.spread * path.spread > options_.cache.spread_threshold * path.first_spread;
    case QueryAt::none:
      break;
  }
  return false;
}

void CachedPaths::add_emission(const Path& path, const Color& emission, PathBatch& batch) const {
  if (path.vertex == kNone) {
    batch.emission[path.index] += path.links.emission * emission;
    return;
  }
  PathVertex& from = batch.vertices[static_cast<std::size_t>(path.vertex)];
  from.known += path.links.emission * emission;
  if (from.record != kNone && held_.emission()) batch.target(from.record) += path.links.held * emission;
}

bool CachedPaths::scatter(Path& path, Ray& ray, const Hit& hit, const PathPlan& plan, PathBatch& batch,
                          std::span<FirstHit> first_hits, Scratch& scratch) const {
  const Vec3& direction = ray.direction;
  if (!hit) {
    const Color sky = world_.environment.radiance(direction);
    if ((sky > 0.0f).any())
      add_emission(path, sky * sky_weight(world_, mis_, path.departure, direction), batch);
    return false;
  }
  if ((path.absorption > 0.0f).any()) {
    const Color left = (-path.absorption * hit.t).exp();
    path.links *= left;
    path.throughput *= left;
  }
  const float cone_width = path.cone.width + path.cone.spread * hit.t;
  const Surface surface = world_.surfaces.at(hit, direction, cone_width, texture_level_number(path.seed));
  FirstHit* const first = path.surfaces == 0 && !first_hits.empty() ? &first_hits[path.index] : nullptr;
  if (first) *first = first_hit(hit, surface, world_.scene.origin);
  if ((surface.emission > 0.0f).any()) {
    const float weight = emission_weight(world_, mis_, path.departure, hit, surface, direction);
    add_emission(path, surface.emission * weight, batch);
  }
  // As in PathIntegrator: at the depth's end panes are looked through.
  if (path.depth >= plan.max_depth) path.emission_only = true;
  if (surface.unlit ||
      (path.emission_only && !(surface.material.thin_walled && surface.material.transmission > 0.0f)))
    return false;

  if (plan.query_at == QueryAt::spread) {
    // Mueller et al. 2021, equations 3 and 4; a direction of a delta lobe does not spread.
    const float distance = path.departure.travelled + hit.t;
    const float cosine = std::max(std::abs(surface.geometric_normal.dot(direction)), 1e-4f);
    if (path.surfaces == 0) {
      path.first_spread = distance * distance * kInvFourPi / cosine;
    } else if (!path.departure.delta && path.departure.pdf > 0.0f) {
      path.spread += distance / std::sqrt(path.departure.pdf * cosine);
    }
  }

  const Bsdf bsdf(surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal,
                  -direction, surface.front);
  if (first) first->albedo = bsdf.albedo();
  const Meeting meeting{ray,
                        hit,
                        surface,
                        bsdf,
                        -direction,
                        bsdf.transmits() ? Vec3(Vec3::Zero()) : surface.shading_normal,
                        side_of(surface.front, world_.scene.instances[hit.instance].mirrors),
                        cone_width,
                        dimension::kFirstVertex + dimension::kPerVertex * path.surfaces};
  if (path.emission_only) {
    const BsdfSample sample =
        bsdf.sample(path.sampler.get_1d(meeting.dimensions + dimension::kBsdfLobe),
                    path.sampler.get_2d(meeting.dimensions + dimension::kBsdfDirection));
    return meeting.through_pane(sample) && (sample.weight > 0.0f).any() &&
           advance(path, meeting, sample, {sample.weight, sample.weight}, kNone);
  }
  const bool wide = bsdf.has_wide(options_.cache.min_roughness);
  const bool ends = wide && ends_here(path, plan);
  const bool stored =
      (ends || (wide && plan.records)) && stored_(neural::surface_index(hit.instance, meeting.side));
  if (ends && stored) return answer(path, meeting, batch, scratch);
  if (ends) ++batch.unstored_hits;
  const bool teaches =
      plan.records && stored && (plan.most_records == kNone || path.records < plan.most_records);
  return continue_from(path, meeting, teaches, plan, batch, scratch);
}

bool CachedPaths::answer(Path& path, const Meeting& m, PathBatch& batch, Scratch& scratch) const {
  const float roughness = options_.cache.min_roughness;
  const bool has_narrow = m.bsdf.has_narrow(roughness);
  std::optional<Bsdf> part;  // a copy of a surface is not cheap
  if (has_narrow) part = m.bsdf.wide_part(roughness);
  const Color& wide_albedo = part ? part->albedo() : m.bsdf.albedo();
  const auto index = static_cast<std::int32_t>(batch.vertices.size());
  PathVertex& v = batch.vertices.emplace_back();
  v.previous = path.vertex;
  v.path = path.index;
  v.link = path.links.scattered;
  v.held_link = path.links.held;
  if (worth_caching(wide_albedo)) {
    v.reflectance = cache_reflectance(wide_albedo);
    v.query = static_cast<std::int32_t>(batch.queries.size());
    batch.queries.push_back(m.hit, m.side, m.wo, m.surface, wide_albedo);
    if (batch.first_queries[path.index] == kNone) batch.first_queries[path.index] = v.query;
  }

  const auto sample_light = [&] {
    return world_.lights.sample(m.surface.position, m.light_normal,
                                path.sampler.get_1d(m.dimensions + dimension::kLightChoice),
                                path.sampler.get_2d(m.dimensions + dimension::kLightPoint));
  };
  const auto sample_direction = [&](const Bsdf& bsdf) {
    return bsdf.sample(path.sampler.get_1d(m.dimensions + dimension::kBsdfLobe),
                       path.sampler.get_2d(m.dimensions + dimension::kBsdfDirection));
  };
  const auto add_light = [&](const LightSample& light, const BsdfValue& value) {
    if (!(light.pdf > 0.0f)) return;
    const float weight = light.delta ? 1.0f : mis_.light_weight(light.pdf, value.pdf);
    const Color contribution = value.value * light.radiance * (weight / light.pdf);
    if (!(contribution > 0.0f).any()) return;
    scratch.shadow_rays.push_back(shadow_ray(m.surface, light, path.seed));
    scratch.pending.push_back({index, contribution, Color::Zero()});
  };

  if (!held_.emission()) {
    // All direct light is sampled here, of all lobes; what the chosen direction brings from further on counts
    // for the narrow ones alone.
    if (!m.bsdf.is_delta() && !world_.lights.empty()) {
      const LightSample light = sample_light();
      add_light(light, m.bsdf.evaluate(light.wi));
    }
    const BsdfSample sample = sample_direction(m.bsdf);
    if (!(sample.pdf > 0.0f) || !(sample.weight > 0.0f).any()) return false;
    Color scattered = Color::Zero();
    if (sample.delta) {
      scattered = sample.weight;
    } else if (has_narrow) {
      scattered = m.bsdf.narrow_part(roughness).evaluate(sample.wi).value / sample.pdf;
    }
    path.emission_only = !(scattered > 0.0f).any();
    path.throughput *= sample.weight / sample.radiance_scale;
    return advance(path, m, sample, {sample.weight, scattered}, index);
  }

  if (delta_lights_ && !held_.light_sample(true)) {
    const LightSample light = world_.lights.sample_delta(
        m.surface.position, m.light_normal, path.sampler.get_1d(m.dimensions + dimension::kLightChoice),
        path.sampler.get_2d(m.dimensions + dimension::kLightPoint));
    add_light(light, m.bsdf.evaluate(light.wi));
  }
  if (!has_narrow) return false;
  const Bsdf narrow = m.bsdf.narrow_part(roughness);
  if (!narrow.is_delta() && !world_.lights.empty()) {
    const LightSample light = sample_light();
    if (!light.delta || held_.light_sample(true)) add_light(light, narrow.evaluate(light.wi));
  }
  const BsdfSample sample = sample_direction(narrow);
  if (!(sample.pdf > 0.0f) || !(sample.weight > 0.0f).any()) return false;
  path.throughput *= sample.weight / sample.radiance_scale;
  const float survival = std::min(1.0f, kNarrowSurvival * std::sqrt(path.throughput.maxCoeff()));
  if (roulette_number(next_seed(path.seed)) >= survival) return false;
  path.throughput /= survival;
  const Color weight = sample.weight / survival;
  return advance(path, m, sample, {weight, weight}, index);
}

bool CachedPaths::continue_from(Path& path, const Meeting& m, bool record, const PathPlan& plan,
                                PathBatch& batch, Scratch& scratch) const {
  const float roughness = options_.cache.min_roughness;
  const bool split = record && m.bsdf.has_narrow(roughness);
  std::optional<Bsdf> part;  // a copy of a surface is not cheap
  if (split) part = m.bsdf.wide_part(roughness);
  const Bsdf& wide = part ? *part : m.bsdf;
  record = record && worth_caching(wide.albedo());
  const auto index = static_cast<std::int32_t>(batch.vertices.size());
  const auto wide_value = [&](const Vec3& wi, const BsdfValue& whole) -> Color {
    return split ? wide.evaluate(wi).value : whole.value;
  };

  PathVertex& v = batch.vertices.emplace_back();
  v.previous = path.vertex;
  v.path = path.index;
  v.link = path.links.scattered;
  v.held_link = path.links.held;
  if (record) {
    v.reflectance = cache_reflectance(wide.albedo());
    v.record = static_cast<std::int32_t>(batch.records.size());
    batch.records.push_back(m.hit, m.side, m.wo, m.surface, wide.albedo());
    batch.targets.resize(3 * batch.records.size(), 0.0f);
    if (path.records == 0) batch.first_records[path.index] = v.record;
    path.records += 1;
  }
  if (!m.bsdf.is_delta() && !world_.lights.empty()) {
    const LightSample light = world_.lights.sample(
        m.surface.position, m.light_normal, path.sampler.get_1d(m.dimensions + dimension::kLightChoice),
        path.sampler.get_2d(m.dimensions + dimension::kLightPoint));
    if (light.pdf > 0.0f) {
      const BsdfValue value = m.bsdf.evaluate(light.wi);
      const float weight = (light.delta ? 1.0f : mis_.light_weight(light.pdf, value.pdf)) / light.pdf;
      const Color contribution = value.value * light.radiance * weight;
      if ((contribution > 0.0f).any()) {
        Color held = Color::Zero();
        if (record && held_.light_sample(light.delta))
          held = wide_value(light.wi, value) * light.radiance * weight;
        scratch.shadow_rays.push_back(shadow_ray(m.surface, light, path.seed));
        scratch.pending.push_back({index, contribution, held});
      }
    }
  }
  const BsdfSample sample = m.bsdf.sample(path.sampler.get_1d(m.dimensions + dimension::kBsdfLobe),
                                          path.sampler.get_2d(m.dimensions + dimension::kBsdfDirection));
  if (!(sample.pdf > 0.0f) || !(sample.weight > 0.0f).any()) return false;
  path.throughput *= sample.weight / sample.radiance_scale;
  if (!sample.delta && !(sample.spread < roughness * roughness)) path.wide_events += 1;

  const int depth = path.depth + (m.through_pane(sample) ? 0 : 1);
  float survival = 1.0f;
  if (depth >= plan.min_depth) {
    survival = survival_probability(path.throughput);
    if (roulette_number(next_seed(path.seed)) >= survival) return false;
    path.throughput /= survival;
  }
  const Color weight = sample.weight / survival;
  Color held = Color::Zero();
  if (record && !sample.delta)
    held = split ? Color(wide.evaluate(sample.wi).value / (sample.pdf * survival)) : weight;
  return advance(path, m, sample, {weight, weight, held}, index);
}

bool CachedPaths::advance(Path& path, const Meeting& m, const BsdfSample& sample, const Links& links,
                          std::int32_t vertex) const {
  if (m.through_pane(sample)) {
    // What is behind the pane belongs to the vertex before it, whose light samples saw it too.
    path.links *= links.emission;
    path.departure.travelled += m.hit.t;
    path.departure.panes += 1;
  } else {
    path.vertex = vertex;
    path.links = links;
    path.depth += 1;
    path.departure = {m.surface.position, m.light_normal, 0.0f, sample.pdf, sample.delta};
    if (sample.transmitted && !m.surface.material.thin_walled) {
      path.absorption =
          m.surface.front ? absorption_of(world_.surfaces.material(m.hit.instance)) : Color(0.0f, 0.0f, 0.0f);
    }
  }
  path.surfaces += 1;
  if (path.surfaces > path.depth + kMaxPassed) return false;
  path.seed = next_seed(path.seed);
  m.ray = {m.surface.spawn(sample.wi), scene::kInfinity, sample.wi, path.seed};
  path.cone.width = m.cone_width;
  if (!m.through_pane(sample)) path.cone.spread += sample.spread * kDiffuseSpread;
  return true;
}

void CachedPaths::trace(std::span<const PathStart> starts, std::span<const Hit> hits, const PathPlan& plan,
                        PathBatch& batch, std::span<FirstHit> first_hits, RayCounts& counts,
                        Scratch& scratch) const {
  batch.begin(starts.size());
  scratch.paths.resize(starts.size());
  scratch.rays.resize(starts.size());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const CameraSample& s = starts[i].sample;
    Path path;
    path.cone = s.camera_ray.cone;
    path.departure.position = s.camera_ray.ray.origin;
    path.index = static_cast<std::uint32_t>(i);
    path.seed = s.seed;
    path.sampler = s.sampler;
    path.to_its_end = starts[i].to_its_end;
    scratch.paths[i] = path;
    scratch.rays[i] = s.camera_ray.ray;
    scratch.rays[i].seed = s.seed;
    if (!first_hits.empty()) first_hits[i] = {};
  }
  trace_waves(
      world_, hits, scratch, counts,
      [&](Path& path, Ray& ray, const Hit& hit) {
        return scatter(path, ray, hit, plan, batch, first_hits, scratch);
      },
      [&](const Pending& light, const Color& transmittance) {
        PathVertex& v = batch.vertices[static_cast<std::size_t>(light.vertex)];
        v.known += light.direct * transmittance;
        if (v.record != kNone) batch.target(v.record) += light.held * transmittance;
      });
}

}  // namespace gatelight::renderer
