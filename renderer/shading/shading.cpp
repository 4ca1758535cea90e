#include "renderer/shading/shading.h"

#include "base/simd/isa.h"
#include "renderer/bsdf/sheen.h"
#include "renderer/bsdf/tables.h"
#include "renderer/light/punctual.h"
#include "renderer/sampling/sampler.h"
#include "renderer/shading/kernel_tables.h"

namespace gatelight::renderer {
const ShadingKernels& choose_shading_kernels(const std::string& isa) {
  using simd::Isa;
  [[maybe_unused]] const Isa chosen = simd::select_isa(simd::parse_isa(isa));
#if defined(__x86_64__)
  if (chosen == Isa::avx512) return kAvx512Shading;
  if (chosen == Isa::avx2) return kAvx2Shading;
#endif
  return kScalarShading;
}

void put_geometry(ShadingBlock& block, int lane, const Surface& surface, const Vec3& wo) {
  put_lane(block.position, lane, surface.position);
  put_lane(block.geometric_normal, lane, surface.geometric_normal);
  put_lane(block.shading_normal, lane, surface.shading_normal);
  put_lane(block.coat_normal, lane, surface.coat_normal);
  put_lane(block.wo, lane, wo);
  block.offset[lane] = surface.offset;
  const SurfaceMaterial& m = surface.material;
  block.metallic[lane] = m.metallic;
  block.roughness[lane] = m.roughness;
  block.transmission[lane] = m.transmission;
  block.diffuse_transmission[lane] = m.diffuse_transmission;
}

void put_surface(ShadingBlock& block, int lane, const Surface& surface, const Vec3& wo) {
  put_geometry(block, lane, surface, wo);
  const SurfaceMaterial& m = surface.material;
  put_lane(block.base_color, lane, m.base_color);
  block.ior[lane] = m.ior;
  block.specular[lane] = m.specular;
  put_lane(block.specular_color, lane, m.specular_color);
  if (m.diffuse_transmission > 0.0f)
    put_lane(block.diffuse_transmission_color, lane, m.diffuse_transmission_color);
  block.clearcoat[lane] = m.clearcoat;
  block.clearcoat_roughness[lane] = m.clearcoat_roughness;
  put_lane(block.sheen_color, lane, m.sheen_color);
  block.sheen_roughness[lane] = m.sheen_roughness;
}

Shading::Shading(const Lights& lights, const LightArrays& arrays, const ShadingKernels& kernels, bool sheen,
                 DirectLight direct, MisHeuristic heuristic)
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

void Shading::sample_lights(ShadingBlock& points, LightKinds kinds) const {
  if (!wide_lights_) {
    for (int lane = 0; lane < points.count; ++lane) sample_light(lights_, kinds, points, lane);
    return;
  }
  ShadingContext context = context_;
  if (kinds == LightKinds::delta) context.lights = delta_lights_;
  kernels_.sample_lights(points, context);
  if (!lights_are_complete_)
    complete_lights(points, kinds == LightKinds::all ? lights_.triangles().size() : 0);
  if (kinds == LightKinds::all) return;
  // The kernels number them without the triangles.
  for (std::uint32_t& light : points.light) light += static_cast<std::uint32_t>(lights_.triangles().size());
}

void Shading::scatter(SurfaceBlock& block, const ShadingContext& context) const {
  if (!block.scalar.empty()) return scalar_scatter(block, lights_, context);
  sample_lights(block.points, LightKinds::all);
  kernels_.scatter(block.points, context);
}

void Shading::scatter(SurfaceBlock& block) const {
  scatter(block, context_);
}

void Shading::scatter_narrow(SurfaceBlock& block, const Roulette& roulette) const {
  ShadingContext context = context_;
  context.narrow_only = true;
  context.roulette = roulette;
  scatter(block, context);
}

void Shading::delta_light(SurfaceBlock& block) const {
  if (!block.scalar.empty()) return scalar_delta_light(block, lights_, context_);
  sample_lights(block.points, LightKinds::delta);
  kernels_.light(block.points, context_);
}

void Shading::albedo(SurfaceBlock& block) const {
  block.scalar.empty() ? kernels_.albedo(block.points, context_) : scalar_albedo(block, context_);
}

void Shading::complete_lights(ShadingBlock& block, std::size_t first_placed) const {
  for (int lane = 0; lane < block.count; ++lane) complete_light(block, lane, first_placed);
}

void Shading::complete_light(ShadingBlock& block, int lane, std::size_t first_placed) const {
  const Vec2 point(block.light_point[0][lane], block.light_point[1][lane]);
  switch (static_cast<LaneLight>(block.light_state[lane])) {
    case LaneLight::none:
    case LaneLight::done:
      return;
    case LaneLight::triangle:
      put_lane(block.light_radiance, lane,
               lights_.triangles().radiance(lights_.triangles()[block.light[lane]], point));
      break;
    case LaneLight::profile: {
      const float share = profile_share(lights_.placed()[block.light[lane] - first_placed],
                                        lane_vector(block.light_direction, lane));
      put_lane(block.light_radiance, lane, Color(lane_color(block.light_radiance, lane) * share));
      break;
    }
    case LaneLight::environment: {
      const EnvironmentSample sky = lights_.environment().sample(point, light_normal(block, lane));
      put_lane(block.light_direction, lane, sky.wi);
      put_lane(block.light_radiance, lane, sky.radiance);
      block.light_pdf[lane] *= sky.pdf;
      break;
    }
  }
  block.light_state[lane] = static_cast<std::uint32_t>(LaneLight::done);
}

}  // namespace gatelight::renderer
