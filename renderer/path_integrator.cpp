#include "renderer/path_integrator.h"

#include <algorithm>
#include <cmath>

#include "renderer/trace_timer.h"

namespace gatelight::renderer {

namespace {

/// How much a wholly diffuse bounce widens a ray's cone, radians. The next hit's textures are then read at a
/// level that stays in the cache, and their detail is averaged by the hemisphere anyway.
constexpr float kDiffuseSpread = 0.25f;

/// Panes do not count as scattering events; after this many surfaces more than events a path ends.
constexpr int kMaxPassed = 32;

/// Distances below this fraction of the way to the light are its own surface.
constexpr float kShadowEpsilon = 1e-4f;

/// How many hits ahead of shading their data is asked for.
constexpr std::size_t kTriangleAhead = 8;
constexpr std::size_t kVerticesAhead = 4;

Color absorption_of(const scene::Material& m) {
  if (!m.has_volume() || !(m.attenuation_distance < scene::kInfinity)) return Color::Zero();
  // Colour c after distance d: c = exp(-absorption d). A black channel absorbs within a thousandth of the
  // distance.
  return -m.attenuation_color.max(1e-30f).log() / m.attenuation_distance;
}

void append(std::vector<Ray>& log, const std::vector<Ray>& rays) {
  log.insert(log.end(), rays.begin(), rays.end());
}

}  // namespace

PathIntegrator::PathIntegrator(const World& world, const RenderOptions& options)
    : world_(world), options_(options) {}

float PathIntegrator::light_weight(float light_pdf, float bsdf_pdf) const {
  switch (options_.direct) {
    case DirectLight::nee:
      return 1.0f;
    case DirectLight::bsdf:
      return 0.0f;
    case DirectLight::mis:
      break;
  }
  const float ratio = bsdf_pdf / light_pdf;
  return options_.mis == MisHeuristic::balance ? 1.0f / (1.0f + ratio) : 1.0f / (1.0f + ratio * ratio);
}

float PathIntegrator::bsdf_weight(const Path& path, float light_pdf) const {
  if (path.delta || light_pdf <= 0.0f) return 1.0f;
  switch (options_.direct) {
    case DirectLight::nee:
      return 0.0f;
    case DirectLight::bsdf:
      return 1.0f;
    case DirectLight::mis:
      break;
  }
  const float ratio = light_pdf / path.pdf;
  return options_.mis == MisHeuristic::balance ? 1.0f / (1.0f + ratio) : 1.0f / (1.0f + ratio * ratio);
}

void PathIntegrator::add_direct_light(const Path& path, const Surface& surface, const Bsdf& bsdf,
                                      const Vec3& normal, Scratch& scratch) const {
  const std::uint32_t base = dimension::kFirstVertex + dimension::kPerVertex * path.vertex;
  const LightSample light =
      world_.lights.sample(surface.position, normal, path.sampler.get_1d(base + dimension::kLightChoice),
                           path.sampler.get_2d(base + dimension::kLightPoint));
  if (!(light.pdf > 0.0f)) return;
  const BsdfValue value = bsdf.evaluate(light.wi);
  const float weight = light.delta ? 1.0f : light_weight(light.pdf, value.pdf);
  const Color contribution = path.throughput * value.value * light.radiance * (weight / light.pdf);
  if (!(contribution > 0.0f).any()) return;
  Ray ray;
  ray.origin = surface.spawn(light.wi);
  ray.direction = light.wi;
  ray.t_max = light.distance * (1.0f - kShadowEpsilon) - 2.0f * surface.offset;
  ray.seed = hash(path.seed ^ 0x5bd1e995u);
  if (!(ray.t_max > 0.0f)) ray.t_max = 0.5f * light.distance;
  scratch.shadow_rays.push_back(ray);
  scratch.pending.push_back({contribution, path.index});
}

bool PathIntegrator::scatter(Path& path, const Hit& hit, std::span<SampleResult> results,
                             std::span<FirstHit> first_hits, Scratch& scratch) const {
  Color& radiance = results[path.index].radiance;
  const Vec3& direction = path.ray.direction;
  if (!hit) {
    const Color sky = world_.environment.radiance(direction);
    if ((sky > 0.0f).any()) {
      const float pdf =
          path.delta ? 0.0f : world_.lights.pdf_environment(path.previous, path.previous_normal, direction);
      radiance += path.throughput * sky * bsdf_weight(path, pdf);
    }
    return false;
  }
  if ((path.absorption > 0.0f).any()) path.throughput *= (-path.absorption * hit.t).exp();

  const float cone_width = path.cone.width + path.cone.spread * hit.t;
  const Surface surface =
      world_.surfaces.at(hit, direction, cone_width, sampling::to_unit_float(hash(path.seed ^ 0x2545f491u)));
  const bool record = path.vertex == 0 && !first_hits.empty();
  if (record) {
    FirstHit& first = first_hits[path.index];
    first.hit = true;
    first.normal = surface.shading_normal;
    first.position = surface.position;
    first.depth = hit.t;
    first.instance = hit.instance;
    first.primitive = hit.primitive;
    first.albedo = surface.material.base_color;
  }
  if ((surface.emission > 0.0f).any()) {
    const float pdf = path.delta || surface.unlit
                          ? 0.0f
                          : world_.lights.pdf_triangle(path.previous, path.previous_normal, hit.instance,
                                                       hit.primitive, direction, path.travelled + hit.t);
    radiance += path.throughput * surface.emission * bsdf_weight(path, pdf);
  }
  if (surface.unlit || path.depth >= options_.max_depth) return false;

  const Bsdf bsdf(surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal,
                  -direction, surface.front);
  if (record) first_hits[path.index].albedo = bsdf.albedo();
  const Vec3 light_normal = bsdf.transmits() ? Vec3(Vec3::Zero()) : surface.shading_normal;
  if (!bsdf.is_delta() && !world_.lights.empty())
    add_direct_light(path, surface, bsdf, light_normal, scratch);

  const std::uint32_t base = dimension::kFirstVertex + dimension::kPerVertex * path.vertex;
  const BsdfSample sample = bsdf.sample(path.sampler.get_1d(base + dimension::kBsdfLobe),
                                        path.sampler.get_2d(base + dimension::kBsdfDirection));
  if (!(sample.pdf > 0.0f) || !(sample.weight > 0.0f).any()) return false;
  path.throughput *= sample.weight;
  path.radiance_scale *= sample.radiance_scale;
  const bool through_pane = sample.delta && sample.transmitted && surface.material.thin_walled;
  if (through_pane) {
    path.travelled += hit.t;
  } else {
    path.depth += 1;
    path.previous = surface.position;
    path.previous_normal = light_normal;
    path.travelled = 0.0f;
    path.pdf = sample.pdf;
    path.delta = sample.delta;
    if (sample.transmitted && !surface.material.thin_walled) {
      path.absorption =
          surface.front ? absorption_of(world_.surfaces.material(hit.instance)) : Color(0.0f, 0.0f, 0.0f);
    }
  }
  path.vertex += 1;
  if (path.vertex > path.depth + kMaxPassed) return false;
  path.seed = hash(path.seed + 0x9e3779b9u);

  if (path.depth >= options_.min_depth) {
    // The root of what is left: in bright rooms, where long paths carry much, roulette by the throughput
    // itself costs more noise than it saves time (Country Kitchen: a tenth more noise in the same time).
    const float survival = std::min(0.95f, std::sqrt(path.throughput.maxCoeff() / path.radiance_scale));
    if (sampling::to_unit_float(hash(path.seed ^ 0x68bc21ebu)) >= survival) return false;
    path.throughput /= survival;
  }
  path.ray.origin = surface.spawn(sample.wi);
  path.ray.direction = sample.wi;
  path.ray.t_max = scene::kInfinity;
  path.ray.seed = path.seed;
  path.cone.width = cone_width;
  if (!through_pane) path.cone.spread += sample.spread * kDiffuseSpread;
  return true;
}

void PathIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                           std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch) const {
  std::vector<Path>& paths = scratch.paths;
  paths.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Path path;
    path.ray = samples[i].camera_ray.ray;
    path.ray.seed = samples[i].seed;
    path.cone = samples[i].camera_ray.cone;
    path.previous = path.ray.origin;
    path.index = static_cast<std::uint32_t>(i);
    path.seed = samples[i].seed;
    path.sampler = samples[i].sampler;
    paths[i] = path;
    results[i] = {};
    if (!first_hits.empty()) first_hits[i] = {};
  }
  counts.camera += samples.size();

  for (bool camera = true; !paths.empty(); camera = false) {
    if (!camera) counts.bounce += paths.size();
    scratch.rays.resize(paths.size());
    scratch.hits.resize(paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) scratch.rays[i] = paths[i].ray;
    {
      const TraceTimer timer(counts);
      world_.accel.intersect(scratch.rays, scratch.hits, camera);
    }
    if (scratch.log) append(camera ? scratch.log->camera : scratch.log->bounce, scratch.rays);

    scratch.shadow_rays.clear();
    scratch.pending.clear();
    std::size_t alive = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (i + kTriangleAhead < paths.size())
        world_.surfaces.prefetch_triangle(scratch.hits[i + kTriangleAhead]);
      if (i + kVerticesAhead < paths.size())
        world_.surfaces.prefetch_vertices(scratch.hits[i + kVerticesAhead]);
      if (!scatter(paths[i], scratch.hits[i], results, first_hits, scratch)) continue;
      if (alive != i) paths[alive] = paths[i];
      ++alive;
    }
    paths.resize(alive);

    counts.shadow += scratch.shadow_rays.size();
    scratch.transmittance.resize(scratch.shadow_rays.size());
    {
      const TraceTimer timer(counts);
      world_.accel.transmittance(scratch.shadow_rays, scratch.transmittance);
    }
    if (scratch.log) append(scratch.log->shadow, scratch.shadow_rays);
    for (std::size_t i = 0; i < scratch.pending.size(); ++i) {
      results[scratch.pending[i].index].radiance +=
          scratch.pending[i].contribution * scratch.transmittance[i];
    }
  }
}

}  // namespace gatelight::renderer
