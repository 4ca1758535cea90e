#include "renderer/shading/wide_shading.h"

#include "base/simd/isa.h"
#include "renderer/bsdf/sheen.h"
#include "renderer/bsdf/tables.h"
#include "renderer/light/punctual.h"
#include "renderer/sampling/sampler.h"
#include "renderer/shading/kernel_tables.h"

namespace gatelight::renderer {
namespace {

template <class Vector>
void put(float (&a)[3][ShadingBlock::kWidth], int lane, const Vector& v) {
  for (int c = 0; c < 3; ++c) a[c][lane] = v[c];
}

}  // namespace

const ShadingKernels& choose_shading_kernels(const std::string& isa) {
  using simd::Isa;
  [[maybe_unused]] const Isa chosen = simd::select_isa(simd::parse_isa(isa));
#if defined(__x86_64__)
  if (chosen == Isa::avx512) return kAvx512Shading;
  if (chosen == Isa::avx2) return kAvx2Shading;
#endif
  return kScalarShading;
}

void put_surface(ShadingBlock& block, int lane, const Surface& surface, const Vec3& wo) {
  put(block.position, lane, surface.position);
  put(block.geometric_normal, lane, surface.geometric_normal);
  put(block.shading_normal, lane, surface.shading_normal);
  put(block.coat_normal, lane, surface.coat_normal);
  put(block.wo, lane, wo);
  block.offset[lane] = surface.offset;
  const SurfaceMaterial& m = surface.material;
  put(block.base_color, lane, m.base_color);
  block.metallic[lane] = m.metallic;
  block.roughness[lane] = m.roughness;
  block.ior[lane] = m.ior;
  block.specular[lane] = m.specular;
  put(block.specular_color, lane, m.specular_color);
  block.transmission[lane] = m.transmission;
  block.diffuse_transmission[lane] = m.diffuse_transmission;
  if (m.diffuse_transmission > 0.0f)
    put(block.diffuse_transmission_color, lane, m.diffuse_transmission_color);
  block.clearcoat[lane] = m.clearcoat;
  block.clearcoat_roughness[lane] = m.clearcoat_roughness;
  put(block.sheen_color, lane, m.sheen_color);
  block.sheen_roughness[lane] = m.sheen_roughness;
}

WideShading::WideShading(const Lights& lights, const LightArrays& arrays, const ShadingKernels& kernels,
                         bool sheen, DirectLight direct, MisHeuristic heuristic)
    : lights_(lights),
      kernels_(kernels),
      wide_lights_(arrays.view() != nullptr),
      lights_are_complete_(arrays.complete()) {
  if (wide_lights_) {
    context_.lights = *arrays.view();
    delta_lights_ = arrays.delta_view();
  }
  context_.tables = {GgxTables::get().values(), GgxTables::get().means(),
                     sheen ? SheenTables::get().values() : nullptr};
  context_.direct = direct;
  context_.heuristic = heuristic;
}

void WideShading::sample_lights(ShadingBlock& block) const {
  if (wide_lights_) {
    kernels_.sample_lights(block, context_);
    if (!lights_are_complete_) complete_lights(block, lights_.triangles().size());
  } else {
    for (int lane = 0; lane < block.count; ++lane) put_light(block, lane, false);
  }
}

void WideShading::scatter(ShadingBlock& block) const {
  sample_lights(block);
  kernels_.scatter(block, context_);
}

void WideShading::scatter_narrow(ShadingBlock& block, const Roulette& roulette) const {
  sample_lights(block);
  ShadingContext context = context_;
  context.narrow_only = true;
  context.roulette = roulette;
  kernels_.scatter(block, context);
}

void WideShading::delta_light(ShadingBlock& block) const {
  ShadingContext context = context_;
  context.lights = delta_lights_;
  if (wide_lights_) {
    kernels_.sample_lights(block, context);
    if (!lights_are_complete_) complete_lights(block, 0);
  } else {
    for (int lane = 0; lane < block.count; ++lane) put_light(block, lane, true);
  }
  kernels_.light(block, context);
}

void WideShading::complete_lights(ShadingBlock& block, std::size_t first_placed) const {
  for (int lane = 0; lane < block.count; ++lane) complete_light(block, lane, first_placed);
}

void WideShading::complete_light(ShadingBlock& block, int lane, std::size_t first_placed) const {
  const Vec2 point(block.light_point[0][lane], block.light_point[1][lane]);
  switch (static_cast<LaneLight>(block.light_state[lane])) {
    case LaneLight::none:
    case LaneLight::done:
      return;
    case LaneLight::triangle:
      put(block.light_radiance, lane,
          lights_.triangles().radiance(lights_.triangles()[block.light[lane]], point));
      break;
    case LaneLight::profile: {
      const float share = profile_share(lights_.placed()[block.light[lane] - first_placed],
                                        lane_vector(block.light_direction, lane));
      put(block.light_radiance, lane, Color(lane_color(block.light_radiance, lane) * share));
      break;
    }
    case LaneLight::environment: {
      const EnvironmentSample sky = lights_.environment().sample(point, light_normal(block, lane));
      put(block.light_direction, lane, sky.wi);
      put(block.light_radiance, lane, sky.radiance);
      block.light_pdf[lane] *= sky.pdf;
      break;
    }
  }
  block.light_state[lane] = static_cast<std::uint32_t>(LaneLight::done);
}

/// Samples a light by the scalar code. delta: Lights::sample_delta.
void WideShading::put_light(ShadingBlock& block, int lane, bool delta) const {
  const Sampler sampler =
      Sampler::from_parts(block.sampler, block.sampler_key[lane], block.sampler_index[lane]);
  const std::uint32_t dimensions = block.dimensions[lane];
  const Vec3 position = lane_vector(block.position, lane), normal = light_normal(block, lane);
  const float choice = sampler.get_1d(dimensions + 2);
  const Vec2 point = sampler.get_2d(dimensions + 3);
  const LightSample s = delta ? lights_.sample_delta(position, normal, choice, point)
                              : lights_.sample(position, normal, choice, point);
  block.light_state[lane] = static_cast<std::uint32_t>(s.pdf > 0.0f ? LaneLight::done : LaneLight::none);
  block.light_is_delta[lane] = s.delta ? ~0u : 0u;
  put(block.light_direction, lane, s.wi);
  block.light_distance[lane] = s.distance;
  put(block.light_radiance, lane, s.radiance);
  block.light_pdf[lane] = s.pdf;
  block.light_offset[lane] = s.offset;
  block.light_cosine[lane] = s.cosine;
  block.light[lane] = s.light;
}

}  // namespace gatelight::renderer
