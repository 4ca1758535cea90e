#include "renderer/transport/path_integrator.h"

#include <algorithm>
#include <cmath>

#include "renderer/film/first_hit.h"

namespace gatelight::renderer {

PathIntegrator::PathIntegrator(const World& world, const RenderOptions& options)
    : world_(world), options_(options), mis_{options.direct, options.mis} {}

void PathIntegrator::add_direct_light(const Path& path, const Surface& surface, const Bsdf& bsdf,
                                      const Vec3& normal, Scratch& scratch) const {
  const std::uint32_t base =
      dimension::kFirstVertex + dimension::kPerVertex * static_cast<std::uint32_t>(path.vertex);
  const LightSample light =
      world_.lights.sample(surface.position, normal, path.sampler.get_1d(base + dimension::kLightChoice),
                           path.sampler.get_2d(base + dimension::kLightPoint));
  if (!(light.pdf > 0.0f)) return;
  const BsdfValue value = bsdf.evaluate(light.wi);
  const float weight = light.delta ? 1.0f : mis_.light_weight(light.pdf, value.pdf);
  const Color contribution = path.carried() * value.value * light.radiance * (weight / light.pdf);
  if (!(contribution > 0.0f).any()) return;
  scratch.shadow_rays.push_back(shadow_ray(surface, light, path.seed));
  scratch.pending.push_back({contribution, path.index});
}

bool PathIntegrator::scatter(Path& path, Ray& ray, const Hit& hit, std::span<SampleResult> results,
                             std::span<FirstHit> first_hits, Scratch& scratch) const {
  Color& radiance = results[path.index].radiance;
  const Vec3& direction = ray.direction;
  if (!hit) {
    const Color sky = world_.environment.radiance(direction);
    if ((sky > 0.0f).any()) {
      radiance += path.carried() * sky * sky_weight(world_, mis_, path.departure, direction);
    }
    return false;
  }
  if ((path.absorption > 0.0f).any()) path.throughput *= (-path.absorption * hit.t).exp();

  const float cone_width = path.cone.width + path.cone.spread * hit.t;
  const Surface surface = world_.surfaces.at(hit, direction, cone_width, texture_level_number(path.seed));
  const bool record = path.vertex == 0 && !first_hits.empty();
  if (record) first_hits[path.index] = first_hit(hit, surface, world_.scene.origin);
  if ((surface.emission > 0.0f).any()) {
    radiance += path.carried() * surface.emission *
                emission_weight(world_, mis_, path.departure, hit, surface, direction);
  }
  // Behind a pane there is still what the light samples of the vertex before it saw: at the depth's end it is
  // looked at for its emission alone, since half of a weighted sum of both would be too dark.
  const bool emission_only = path.depth >= options_.max_depth;
  if (surface.unlit ||
      (emission_only && !(surface.material.thin_walled && surface.material.transmission > 0.0f)))
    return false;

  const Bsdf bsdf(surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal,
                  -direction, surface.front);
  if (record) first_hits[path.index].albedo = bsdf.albedo();
  const Vec3 light_normal = bsdf.transmits() ? Vec3(Vec3::Zero()) : surface.shading_normal;
  if (!bsdf.is_delta() && !world_.lights.empty() && !emission_only)
    add_direct_light(path, surface, bsdf, light_normal, scratch);

  const std::uint32_t base =
      dimension::kFirstVertex + dimension::kPerVertex * static_cast<std::uint32_t>(path.vertex);
  const BsdfSample sample = bsdf.sample(path.sampler.get_1d(base + dimension::kBsdfLobe),
                                        path.sampler.get_2d(base + dimension::kBsdfDirection));
  if (!(sample.pdf > 0.0f) || !(sample.weight > 0.0f).any()) return false;
  path.throughput *= sample.weight / sample.radiance_scale;
  path.radiance_scale *= static_cast<double>(sample.radiance_scale);
  const bool through_pane = sample.delta && sample.transmitted && surface.material.thin_walled;
  if (emission_only && !through_pane) return false;
  if (through_pane) {
    path.departure.travelled += hit.t;
    path.departure.panes += 1;
  } else {
    path.depth += 1;
    path.departure = {surface.position, light_normal, 0.0f, sample.pdf, sample.delta};
    if (sample.transmitted && !surface.material.thin_walled) {
      path.absorption =
          surface.front ? absorption_of(world_.surfaces.material(hit.instance)) : Color(0.0f, 0.0f, 0.0f);
    }
  }
  path.vertex += 1;
  if (path.vertex > path.depth + kMaxPassed) return false;
  path.seed = next_seed(path.seed);

  if (path.depth >= options_.min_depth) {
    const float survival = survival_probability(path.throughput);
    if (roulette_number(path.seed) >= survival) return false;
    path.throughput /= survival;
  }
  ray = {surface.spawn(sample.wi), scene::kInfinity, sample.wi, path.seed};
  path.cone.width = cone_width;
  if (!through_pane) path.cone.spread += sample.spread * kDiffuseSpread;
  return true;
}

void PathIntegrator::trace(std::span<const CameraSample> samples, std::span<SampleResult> results,
                           std::span<FirstHit> first_hits, RayCounts& counts, Scratch& scratch) const {
  scratch.paths.resize(samples.size());
  scratch.rays.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Path path;
    path.cone = samples[i].camera_ray.cone;
    path.departure.position = samples[i].camera_ray.ray.origin;
    path.index = static_cast<std::uint32_t>(i);
    path.seed = samples[i].seed;
    path.sampler = samples[i].sampler;
    scratch.paths[i] = path;
    scratch.rays[i] = samples[i].camera_ray.ray;
    scratch.rays[i].seed = samples[i].seed;
    results[i] = {};
    if (!first_hits.empty()) first_hits[i] = {};
  }
  trace_waves(
      world_, {}, scratch, counts,
      [&](Path& path, Ray& ray, const Hit& hit) {
        return scatter(path, ray, hit, results, first_hits, scratch);
      },
      [&](const PendingLight& light, const Color& transmittance) {
        results[light.index].radiance += light.contribution * transmittance;
      });
}

}  // namespace gatelight::renderer
