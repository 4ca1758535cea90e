// The kernels of wide shading on random points, by instruction set: light samples among 200 lamps, and the
// rest of shading. Items are points.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "base/simd/isa.h"
#include "renderer/bsdf/tables.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"
#include "renderer/shading/shading.h"

namespace gatelight::bench {
namespace {

using namespace renderer;

constexpr std::size_t kBlocks = 64;  // they stay in the second-level cache

/// The numbers of a random sequence, one after the other.
struct Numbers {
  Sampler sampler{SamplerKind::independent, 1, 0, 0, 0};
  std::uint32_t next = 0;
  float one() { return sampler.get_1d(next++); }
  Vec3 direction() { return sample_uniform_sphere(sampler.get_2d(next++)); }
};

/// 200 triangles around the origin.
struct Lamps {
  scene::Scene scene;
  Textures textures{scene};
  Environment environment{{}};
  Lights lights;
  LightArrays arrays{lights};

  Lamps() : scene(make()), lights(scene, textures, environment, LightSelection::tree) {}

  static scene::Scene make() {
    Numbers numbers;
    scene::Scene scene;
    scene::Mesh mesh;
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Vec3 at = (2.0f + 20.0f * numbers.one()) * numbers.direction();
      for (const Vec3& corner : {at, Vec3(at + numbers.direction()), Vec3(at + numbers.direction())}) {
        mesh.positions.push_back(corner);
        scene.bounds.extend(corner);
      }
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    scene::Material material;
    material.emission = Color(1.0f, 2.0f, 3.0f);
    mesh.material = 0;
    scene.materials.push_back(material);
    scene.meshes.push_back(std::move(mesh));
    scene::Instance instance;
    instance.mesh = 0;
    instance.baked = true;
    scene.instances.push_back(instance);
    return scene;
  }
};

/// Opaque surfaces with microfacets.
std::vector<ShadingBlock> random_blocks() {
  Numbers numbers;
  std::vector<ShadingBlock> blocks(kBlocks);
  for (ShadingBlock& block : blocks) {
    block = {};
    for (int lane = 0; lane < ShadingBlock::kWidth; ++lane) {
      Surface s;
      s.geometric_normal = numbers.direction();
      s.shading_normal = s.coat_normal = (s.geometric_normal + 0.3f * numbers.direction()).normalized();
      s.position = 3.0f * numbers.direction();
      s.offset = 1e-5f;
      s.material.base_color = Color(numbers.one(), numbers.one(), numbers.one());
      s.material.metallic = numbers.one();
      s.material.roughness = 0.1f + 0.9f * numbers.one();
      Vec3 wo = numbers.direction();
      if (wo.dot(s.geometric_normal) < 0.0f) wo = -wo;
      put_surface(block, lane, s, wo);
      block.sampler_key[lane] = static_cast<std::uint32_t>(numbers.one() * 0x1p24f);
      block.dimensions[lane] = 1;
      block.events_before_roulette[lane] = 1000;
      ++block.count;
    }
  }
  return blocks;
}

using Kernel = void (*ShadingKernels::*)(ShadingBlock&, const ShadingContext&);

void run(benchmark::State& state, const std::string& isa, Kernel kernel) {
  const Lamps lamps;
  const ShadingKernels& kernels = choose_shading_kernels(isa);
  ShadingContext context;
  context.lights = *lamps.arrays.view();
  context.tables = {GgxTables::get().values(), GgxTables::get().means(), nullptr};
  std::vector<ShadingBlock> blocks = random_blocks();
  for (ShadingBlock& block : blocks) kernels.sample_lights(block, context);
  for (auto _ : state) {
    for (ShadingBlock& block : blocks) (kernels.*kernel)(block, context);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(kBlocks * ShadingBlock::kWidth));
}

const int shading_registered = [] {
  for (const simd::Isa isa : simd::available_isas()) {
    const std::string name(simd::isa_name(isa));
    for (const auto& [what, kernel] :
         {std::pair("lights", &ShadingKernels::sample_lights), std::pair("scatter", &ShadingKernels::scatter),
          std::pair("albedo", &ShadingKernels::albedo)}) {
      benchmark::RegisterBenchmark(("shading/" + std::string(what) + "/" + name).c_str(),
                                   [name, chosen = kernel](benchmark::State& s) { run(s, name, chosen); });
    }
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
