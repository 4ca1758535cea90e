#pragma once
// Blocks for the kernels of wide shading, and the same points for the scalar code.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "base/simd/isa.h"
#include "renderer/bsdf/bsdf.h"
#include "renderer/bsdf/sheen.h"
#include "renderer/bsdf/tables.h"
#include "renderer/sampling/sampler.h"
#include "renderer/shading/shading.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer::lanes {

using gatelight::testing::Random;

/// A point, as the scalar code takes it.
struct LanePoint {
  Surface surface;
  Vec3 wo = Vec3::UnitZ();
  Sampler sampler;
  std::uint32_t dimensions = dimension_base();
  std::uint32_t seed = 0;
  Color throughput = Color::Ones();
  int events_before_roulette = 1000;

  static constexpr std::uint32_t dimension_base() { return 1; }

  bool sheet() const {
    const SurfaceMaterial& m = surface.material;
    return std::max(m.transmission, m.diffuse_transmission) * (1.0f - m.metallic) > 0.0f;
  }
  Vec3 light_normal() const { return sheet() ? Vec3(Vec3::Zero()) : surface.shading_normal; }
  Bsdf bsdf() const {
    return {surface.material, surface.geometric_normal, surface.shading_normal, surface.coat_normal, wo,
            surface.front};
  }
  BsdfSample sample(const Bsdf& bsdf) const {
    return bsdf.sample(sampler.get_1d(dimensions), sampler.get_2d(dimensions + 1));
  }
};

inline void put(ShadingBlock& block, const LanePoint& p) {
  const int lane = block.count++;
  put_surface(block, lane, p.surface, p.wo);
  block.sampler = p.sampler.kind();
  block.sampler_key[lane] = p.sampler.key();
  block.sampler_index[lane] = p.sampler.index();
  block.dimensions[lane] = p.dimensions;
  block.seed[lane] = p.seed;
  block.events_before_roulette[lane] = static_cast<std::uint32_t>(p.events_before_roulette);
  for (int c = 0; c < 3; ++c) block.throughput[c][lane] = p.throughput[c];
}

/// A light sample of white light from `wi`, which no direction of the BSDF would find unless `pdf` says so.
inline void put_light(ShadingBlock& block, int lane, const Vec3& wi, bool delta, float pdf) {
  block.light_state[lane] = static_cast<std::uint32_t>(LaneLight::done);
  block.light_is_delta[lane] = delta ? ~0u : 0u;
  for (int c = 0; c < 3; ++c) {
    block.light_direction[c][lane] = wi[c];
    block.light_radiance[c][lane] = 1.0f;
  }
  block.light_distance[lane] = kInfinity;
  block.light_pdf[lane] = pdf;
  block.light_offset[lane] = 0.0f;
  block.light_cosine[lane] = 1.0f;
}

inline const std::vector<std::pair<std::string, const ShadingKernels*>>& all_kernels() {
  static const auto kernels = [] {
    std::vector<std::pair<std::string, const ShadingKernels*>> result;
    for (const simd::Isa isa : simd::available_isas()) {
      const std::string name(simd::isa_name(isa));
      result.emplace_back(name, &choose_shading_kernels(name));
    }
    return result;
  }();
  return kernels;
}

/// Light samples and bounces combined, by the fastest kernels.
inline Shading make_shading(const Lights& lights, const LightArrays& arrays) {
  return {lights, arrays, choose_shading_kernels("auto"), true, DirectLight::mis, MisHeuristic::power};
}

inline ShadingContext tables_only() {
  ShadingContext context;
  context.tables = {GgxTables::get().values(), GgxTables::get().means(), SheenTables::get().values()};
  return context;
}

/// Clears the shadow rays of lanes where light adds nothing: kernels may write them or not.
inline void clear_unused_shadow_rays(ShadingBlock& block) {
  for (int lane = 0; lane < block.count; ++lane) {
    if ((lane_color(block.direct, lane) != 0.0f).any()) continue;
    for (auto& x : block.shadow_origin) x[lane] = 0.0f;
    block.shadow_length[lane] = 0.0f;
    block.shadow_seed[lane] = 0;
  }
}

/// Runs a kernel of every instruction set on copies of a block that is cleared beyond its lanes, and expects
/// the same bits. Returns one of the results.
inline ShadingBlock run_all(const ShadingBlock& block, const ShadingContext& context,
                            void (*ShadingKernels::*kernel)(ShadingBlock&, const ShadingContext&)) {
  ShadingBlock first;
  for (std::size_t k = 0; k < all_kernels().size(); ++k) {
    ShadingBlock result = block;
    (all_kernels()[k].second->*kernel)(result, context);
    clear_unused_shadow_rays(result);
    if (k == 0) {
      first = result;
      continue;
    }
    // Lanes beyond the last vector of one instruction set are within that of another.
    const auto* a = reinterpret_cast<const unsigned char*>(&first) + offsetof(ShadingBlock, position);
    const auto* b = reinterpret_cast<const unsigned char*>(&result) + offsetof(ShadingBlock, position);
    for (std::size_t i = 0; i < sizeof(ShadingBlock) - offsetof(ShadingBlock, position); i += 4) {
      const std::size_t word = (offsetof(ShadingBlock, position) + i) / 4;
      const auto lane = static_cast<int>(word % ShadingBlock::kWidth);
      if (lane < block.count && std::memcmp(a + i, b + i, 4) != 0) {
        ADD_FAILURE() << all_kernels()[0].first << " and " << all_kernels()[k].first << " differ in word "
                      << word << ", lane " << lane;
        return first;
      }
    }
  }
  return first;
}

inline Vec3 random_direction(Random& random) {
  for (;;) {
    Vec3 v;  // one number a statement: compilers evaluate arguments in orders of their own
    for (const int axis : {2, 1, 0}) v[axis] = random.uniform_float() * 2.0f - 1.0f;
    if (v.squaredNorm() > 0.01f && v.squaredNorm() < 1.0f) return v.normalized();
  }
}

/// A direction above the plane of n, at times grazing.
inline Vec3 random_above(Random& random, const Vec3& n) {
  Vec3 v = random_direction(random);
  if (v.dot(n) < 0.0f) v = -v;
  if (random.uniform_float() < 0.2f) v = (v - n * (v.dot(n) - 1e-3f * random.uniform_float())).normalized();
  return v;
}

/// Zero, one, an extreme, or anything in [0, 1].
inline float random_factor(Random& random) {
  const float u = random.uniform_float();
  if (u < 0.15f) return 0.0f;
  if (u < 0.3f) return 1.0f;
  if (u < 0.35f) return 1e-4f;
  if (u < 0.4f) return -0.0f;
  return random.uniform_float();
}
inline Color random_color(Random& random) {
  return {random_factor(random), random_factor(random), random_factor(random)};
}

/// A surface with random lobes; every second one has layers or lets light through.
inline LanePoint random_point(Random& random) {
  LanePoint p;
  Surface& s = p.surface;
  s.geometric_normal = random.uniform_float() < 0.1f
                           ? Vec3(0.0f, 0.0f, random.uniform_float() < 0.5f ? -1.0f : 1.0f)
                           : random_direction(random);
  const auto tilted = [&] {
    const Vec3 direction = random_direction(random);
    const float scale = 0.4f * random.uniform_float();
    const Vec3 n = (s.geometric_normal + scale * direction).normalized();
    return random.uniform_float() < 0.3f ? s.geometric_normal : n;
  };
  s.smooth_normal = s.shading_normal = tilted();
  s.coat_normal = tilted();
  s.position = 3.0f * random_direction(random);
  s.offset = 1e-5f;
  p.wo = random_above(random, s.geometric_normal);
  SurfaceMaterial& m = s.material;
  m.base_color = random_color(random);
  m.metallic = random_factor(random);
  m.roughness = random_factor(random);
  m.ior = random.uniform_float() < 0.2f ? 0.0f : 1.0f + 2.0f * random_factor(random);
  m.specular = random_factor(random);
  m.specular_color = random_color(random);
  if (random.uniform_float() < 0.3f) m.transmission = random_factor(random);
  if (random.uniform_float() < 0.3f) {
    m.diffuse_transmission = random_factor(random);
    m.diffuse_transmission_color = random_color(random);
  }
  if (random.uniform_float() < 0.3f) {
    m.clearcoat = random_factor(random);
    m.clearcoat_roughness = random_factor(random);
  }
  if (random.uniform_float() < 0.3f) {
    m.sheen_color = random_color(random);
    m.sheen_roughness = random_factor(random);
  }
  const auto number = [&] { return static_cast<std::uint32_t>(random.uniform_float() * 0x1p24f); };
  const std::uint32_t d = number(), c = number(), b = number(), a = number();
  p.sampler = Sampler(SamplerKind::sobol, a, b, c, d);
  p.dimensions = 1 + 4 * (number() % 100);
  p.seed = hash(number());
  return p;
}

}  // namespace gatelight::renderer::lanes
