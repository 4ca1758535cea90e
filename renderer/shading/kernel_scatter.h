#pragma once
// Scattering at all lanes: direct light, a new direction, Russian roulette. The SIMD version of PathState.
// Part of kernel_table.cpp.

#include "renderer/shading/kernel_bsdf.h"
#include "renderer/shading/kernel_lights.h"

namespace {

using gatelight::renderer::DirectLight;
using gatelight::renderer::MisHeuristic;

/// MisRule::light_weight.
GATELIGHT_INLINE Float light_weight(const ShadingContext& context, Float light_pdf, Float bsdf_pdf) {
  if (context.direct == DirectLight::nee) return 1.0f;
  if (context.direct == DirectLight::bsdf) return 0.0f;
  const Float ratio = bsdf_pdf / light_pdf;
  return 1.0f / (1.0f + (context.heuristic == MisHeuristic::balance ? ratio : ratio * ratio));
}

GATELIGHT_INLINE void albedo_at(ShadingBlock& block, const ShadingContext& context, int at) {
  store(block.albedo, at, LaneBsdf(block, context, at).albedo);
}

/// Surface::spawn.
GATELIGHT_INLINE Float3 spawn(const ShadingBlock& block, int at, Float3 ng, Float3 direction) {
  const Float offset = load(block.offset + at);
  return load(block.position, at) + ng * select(dot(ng, direction) < 0.0f, -offset, offset);
}

/// Evaluates the BSDF towards the light sample and sets up the shadow ray. Stores the albedos as well.
GATELIGHT_INLINE void evaluate_light(ShadingBlock& block, const ShadingContext& context, const LaneBsdf& bsdf,
                                     int at) {
  store(block.albedo, at, bsdf.albedo);
  if (context.separates_wide) store(block.wide_albedo, at, bsdf.wide_albedo);
  const Float light_pdf = load(block.light_pdf + at);
  const Mask lit =
      (load(block.light_state + at) == state_of(LaneLight::done)) & (light_pdf > 0.0f) & ~bsdf.is_delta;
  if (any(lit)) {
    const Float3 wi = load(block.light_direction, at);
    const LaneValue value = bsdf.evaluate(wi);
    const Mask delta = mask_of(load(block.light_is_delta + at));
    const Float weight = select(delta, 1.0f, light_weight(context, light_pdf, value.pdf)) / light_pdf;
    const Float3 light = load(block.light_radiance, at) * weight;
    store(block.direct, at, select_or_zero(lit, value.value * light));
    if (bsdf.separates_wide) store(block.wide_direct, at, select_or_zero(lit, value.wide * light));
    store(block.shadow_origin, at, spawn(block, at, bsdf.ng, wi));
    const Float distance = load(block.light_distance + at);
    const Float length = distance - (load(block.light_offset + at) + 2.0f * load(block.offset + at)) /
                                        load(block.light_cosine + at);
    store(block.shadow_length + at, select(length > 0.0f, length, 0.5f * distance));
    store(block.shadow_seed + at, hash(load(block.seed + at) ^ 0x5bd1e995u));
  } else {
    store(block.direct, at, repeat(0.0f));
    store(block.wide_direct, at, repeat(0.0f));
  }
}

/// Evaluates the light sample, and samples a direction: PathState::sample_bsdf and survives.
GATELIGHT_INLINE void scatter_at(ShadingBlock& block, const ShadingContext& context, int at) {
  const LaneBsdf bsdf(block, context, at);
  evaluate_light(block, context, bsdf, at);
  const LaneSampler sampler{block.sampler, load(block.sampler_key + at), load(block.sampler_index + at)};
  const Int dimensions = load(block.dimensions + at);
  LaneSample s = bsdf.sample(sampler.get_1d(dimensions), sampler.get_2d(dimensions + 1u));
  Mask alive = (s.pdf > 0.0f) & any_positive(s.weight);
  const Int next = hash(load(block.seed + at) + 0x9e3779b9u);
  const Mask through_pane = s.delta & s.transmitted;
  const Float events = to_float(load(block.events_before_roulette + at));
  const Mask plays = events <= select_or_zero(~through_pane, Float(1.0f));
  const Mask is_long = events <= Float(static_cast<float>(-context.roulette.long_path));
  const Float kept = context.roulette.factor * sqrt(largest(load(block.throughput, at) * s.weight));
  const Float survival =
      select(plays, min(select(is_long, Float(context.roulette.most), Float(1.0f)), kept), 1.0f);
  alive &= ~plays | (to_unit_float(hash(next ^ 0x68bc21ebu)) < survival);
  store(block.alive, at, alive);
  store(block.is_delta, at, s.delta);
  store(block.transmitted, at, s.transmitted);
  store(block.wi, at, s.wi);
  store(block.weight, at, s.weight * (1.0f / survival));
  if (bsdf.separates_wide) store(block.wide_weight, at, s.wide_weight * (1.0f / survival));
  store(block.pdf + at, s.pdf);
  store(block.spread + at, s.spread);
  store(block.survival + at, survival);
  store(block.next_origin, at, spawn(block, at, bsdf.ng, s.wi));
  store(block.next_seed + at, next);
}

}  // namespace
