#include "renderer/shading/scalar_shading.h"

#include <algorithm>
#include <cmath>

#include "renderer/sampling/sampler.h"
#include "renderer/shading/mis_rule.h"
#include "renderer/shading/path_seeds.h"

namespace gatelight::renderer {
namespace {

/// The lobes of a lane that the cache stores, where the context separates them.
struct WideLobes {
  std::optional<Bsdf> part;     ///< a copy of a surface is not cheap
  const Bsdf* lobes = nullptr;  ///< null: the surface has none

  WideLobes(const Bsdf& bsdf, const ShadingContext& context) {
    if (!context.separates_wide || !bsdf.has_wide(context.min_roughness)) return;
    if (bsdf.has_narrow(context.min_roughness)) part = bsdf.wide_part(context.min_roughness);
    lobes = part ? &*part : &bsdf;
  }
};

void put_albedos(ShadingBlock& block, int lane, const Bsdf& bsdf, const WideLobes& wide) {
  put_lane(block.albedo, lane, bsdf.albedo());
  put_lane(block.wide_albedo, lane, wide.lobes ? wide.lobes->albedo() : Color(Color::Zero()));
}

/// Surface::spawn.
Vec3 spawn(const ShadingBlock& block, int lane, const Vec3& direction) {
  const Vec3 ng = lane_vector(block.geometric_normal, lane);
  const float offset = block.offset[lane];
  return lane_vector(block.position, lane) + ng * (ng.dot(direction) < 0.0f ? -offset : offset);
}

void put_shadow_ray(ShadingBlock& block, int lane, const Vec3& wi) {
  put_lane(block.shadow_origin, lane, spawn(block, lane, wi));
  const float distance = block.light_distance[lane];
  const float length =
      distance - (block.light_offset[lane] + 2.0f * block.offset[lane]) / block.light_cosine[lane];
  block.shadow_length[lane] = length > 0.0f ? length : 0.5f * distance;
  block.shadow_seed[lane] = shadow_seed(block.seed[lane]);
}

/// Samples a light for a lane, and evaluates the lobes of `bsdf` towards it.
void sample_direct(SurfaceBlock& surfaces, int lane, const Bsdf& bsdf, const Bsdf* wide, const Lights& lights,
                   LightKinds kinds, const ShadingContext& context) {
  ShadingBlock& block = surfaces.points;
  const ScalarLane& scalar = surfaces.scalar[static_cast<std::size_t>(lane)];
  put_lane(block.direct, lane, Color(Color::Zero()));
  put_lane(block.wide_direct, lane, Color(Color::Zero()));
  if (scalar.only_panes || bsdf.is_delta()) return;
  sample_light(lights, kinds, block, lane);
  if (block.light_state[lane] == static_cast<std::uint32_t>(LaneLight::none)) return;
  const Vec3 wi = lane_vector(block.light_direction, lane);
  if (scalar.front_lights && wi.dot(lane_vector(block.geometric_normal, lane)) < 0.0f) return;
  const BsdfValue value = bsdf.evaluate(wi);
  const MisRule mis{context.direct, context.heuristic};
  const float pdf = block.light_pdf[lane];
  const float weight = (block.light_is_delta[lane] != 0 ? 1.0f : mis.light_weight(pdf, value.pdf)) / pdf;
  const Color light = lane_color(block.light_radiance, lane) * weight;
  put_lane(block.direct, lane, Color(value.value * light));
  if (wide) {
    put_lane(block.wide_direct, lane,
             Color((wide == &bsdf ? value.value : wide->evaluate(wi).value) * light));
  }
  put_shadow_ray(block, lane, wi);
}

/// Russian roulette of a sampled direction with this weight; the survival probability is in the block.
bool survives(ShadingBlock& block, int lane, const Color& weight, bool through_pane,
              const ShadingContext& context) {
  block.survival[lane] = 1.0f;
  const auto events = static_cast<std::int32_t>(block.events_before_roulette[lane]);
  if (events > (through_pane ? 0 : 1)) return true;
  const Color throughput = lane_color(block.throughput, lane) * weight;
  const Roulette& roulette = context.roulette;
  const float most = events <= -roulette.long_path ? roulette.most : 1.0f;
  block.survival[lane] = std::min(most, roulette.factor * std::sqrt(throughput.maxCoeff()));
  return roulette_number(next_seed(block.seed[lane])) < block.survival[lane];
}

/// Samples a direction of the lobes of `bsdf`.
void sample_direction(SurfaceBlock& surfaces, int lane, const Bsdf& bsdf, const Bsdf* wide,
                      const ShadingContext& context) {
  ShadingBlock& block = surfaces.points;
  ScalarLane& scalar = surfaces.scalar[static_cast<std::size_t>(lane)];
  const Sampler sampler =
      Sampler::from_parts(block.sampler, block.sampler_key[lane], block.sampler_index[lane]);
  const std::uint32_t dimensions = block.dimensions[lane];
  const BsdfSample s = bsdf.sample(sampler.get_1d(dimensions), sampler.get_2d(dimensions + 1));
  block.alive[lane] = 0;
  if (!(s.pdf > 0.0f) || !(s.weight > 0.0f).any()) return;
  const bool through_pane = s.delta && s.transmitted && scalar.thin_walled;
  if (scalar.only_panes && !through_pane) return;
  const Color weight = s.weight / s.radiance_scale;
  if (!survives(block, lane, weight, through_pane, context)) return;
  const float survival = block.survival[lane];
  block.alive[lane] = ~0u;
  block.is_delta[lane] = s.delta ? ~0u : 0u;
  block.transmitted[lane] = s.transmitted ? ~0u : 0u;
  put_lane(block.wi, lane, s.wi);
  put_lane(block.weight, lane, Color(weight / survival));
  block.pdf[lane] = s.pdf;
  block.spread[lane] = s.spread;
  put_lane(block.next_origin, lane, spawn(block, lane, s.wi));
  block.next_seed[lane] = next_seed(block.seed[lane]);
  scalar.radiance_scale = s.radiance_scale;
  Color wide_weight = Color::Zero();
  if (wide && !s.delta)
    wide_weight = wide == &bsdf ? Color(weight / survival)
                                : Color(wide->evaluate(s.wi).value / (s.pdf * survival * s.radiance_scale));
  put_lane(block.wide_weight, lane, wide_weight);
}

}  // namespace

void sample_light(const Lights& lights, LightKinds kinds, ShadingBlock& block, int lane) {
  const Sampler sampler =
      Sampler::from_parts(block.sampler, block.sampler_key[lane], block.sampler_index[lane]);
  const std::uint32_t dimensions = block.dimensions[lane];
  const Vec3 position = lane_vector(block.position, lane), normal = light_normal(block, lane);
  const float choice = sampler.get_1d(dimensions + 2), time = block.time[lane];
  const Vec2 point = sampler.get_2d(dimensions + 3);
  const LightSample s = kinds == LightKinds::delta
                            ? lights.sample_delta(position, normal, choice, point, time)
                            : lights.sample(position, normal, choice, point, time);
  block.light_state[lane] = static_cast<std::uint32_t>(s.pdf > 0.0f ? LaneLight::done : LaneLight::none);
  block.light_is_delta[lane] = s.delta ? ~0u : 0u;
  put_lane(block.light_direction, lane, s.wi);
  block.light_distance[lane] = s.distance;
  put_lane(block.light_radiance, lane, s.radiance);
  block.light_pdf[lane] = s.pdf;
  block.light_offset[lane] = s.offset;
  block.light_cosine[lane] = s.cosine;
  block.light[lane] = s.light;
}

void scalar_albedo(SurfaceBlock& block, const ShadingContext& context) {
  for (int lane = 0; lane < block.points.count; ++lane) {
    const Bsdf& bsdf = *block.scalar[static_cast<std::size_t>(lane)].bsdf;
    put_albedos(block.points, lane, bsdf, WideLobes(bsdf, context));
  }
}

void scalar_delta_light(SurfaceBlock& block, const Lights& lights, const ShadingContext& context) {
  for (int lane = 0; lane < block.points.count; ++lane) {
    const Bsdf& bsdf = *block.scalar[static_cast<std::size_t>(lane)].bsdf;
    const WideLobes wide(bsdf, context);
    put_albedos(block.points, lane, bsdf, wide);
    sample_direct(block, lane, bsdf, wide.lobes, lights, LightKinds::delta, context);
  }
}

void scalar_scatter(SurfaceBlock& block, const Lights& lights, const ShadingContext& context) {
  for (int lane = 0; lane < block.points.count; ++lane) {
    const Bsdf& bsdf = *block.scalar[static_cast<std::size_t>(lane)].bsdf;
    const WideLobes wide(bsdf, context);
    put_albedos(block.points, lane, bsdf, wide);
    if (context.narrow_only) {
      const Bsdf narrow = bsdf.narrow_part(context.min_roughness);
      sample_direct(block, lane, narrow, nullptr, lights, LightKinds::all, context);
      sample_direction(block, lane, narrow, nullptr, context);
    } else {
      sample_direct(block, lane, bsdf, wide.lobes, lights, LightKinds::all, context);
      sample_direction(block, lane, bsdf, wide.lobes, context);
    }
  }
}

}  // namespace gatelight::renderer
