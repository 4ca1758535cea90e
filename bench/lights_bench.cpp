#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <vector>

#include "renderer/light/lights.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"
#include "scene/scene.h"

namespace gatelight::renderer {
namespace {

/// Small lamps scattered in a cube of 10 m, and points that sample their light.
struct Lamps {
  scene::Scene scene;
  std::unique_ptr<Textures> textures;
  std::unique_ptr<Environment> environment;

  explicit Lamps(std::uint32_t count) {
    scene.materials.emplace_back().emission = Color(1, 1, 1);
    scene::Mesh mesh;
    mesh.material = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Sampler random(SamplerKind::independent, 1, i, 0, 0);
      const Vec2 xy = random.get_2d(0);
      const Vec3 centre(10.0f * xy.x(), 10.0f * xy.y(), 10.0f * random.get_1d(1));
      const Basis basis(sample_uniform_sphere(random.get_2d(2)));
      const Vec3 end1 = centre + 0.05f * basis.tangent;
      const Vec3 end2 = centre + 0.05f * basis.bitangent;
      mesh.positions.insert(mesh.positions.end(), {centre, end1, end2});
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    scene.meshes.push_back(std::move(mesh));
    scene::Instance instance;
    instance.mesh = 0;
    instance.baked = true;
    scene.instances.push_back(instance);
    textures = std::make_unique<Textures>(scene);
    environment = std::make_unique<Environment>(EnvironmentOptions{});
  }
};

struct Receiver {
  Vec3 p;
  Vec3 n;
};

Receiver receiver(std::uint32_t i) {
  const Sampler random(SamplerKind::independent, 2, i, 0, 0);
  const Vec2 xy = random.get_2d(0);
  return {Vec3(10.0f * xy.x(), 10.0f * xy.y(), 10.0f * random.get_1d(1)),
          sample_uniform_sphere(random.get_2d(2))};
}

void lights_build(benchmark::State& state) {
  const Lamps lamps(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) {
    const Lights lights(lamps.scene, *lamps.textures, *lamps.environment, LightSelection::tree);
    benchmark::DoNotOptimize(lights.bytes());
  }
}

template <LightSelection kSelection>
void lights_sample(benchmark::State& state) {
  const Lamps lamps(static_cast<std::uint32_t>(state.range(0)));
  const Lights lights(lamps.scene, *lamps.textures, *lamps.environment, kSelection);
  std::vector<Receiver> receivers;
  for (std::uint32_t i = 0; i < 1024; ++i) receivers.push_back(receiver(i));
  std::uint32_t i = 0;
  for (auto _ : state) {
    const Receiver& r = receivers[i & 1023u];
    const Sampler random(SamplerKind::independent, 3, i++, 0, 0);
    benchmark::DoNotOptimize(lights.sample(r.p, r.n, random.get_1d(0), random.get_2d(1)).pdf);
  }
}

void lights_pdf(benchmark::State& state) {
  const auto count = static_cast<std::uint32_t>(state.range(0));
  const Lamps lamps(count);
  const Lights lights(lamps.scene, *lamps.textures, *lamps.environment, LightSelection::tree);
  struct Query {
    Receiver receiver;
    std::uint32_t primitive;
    Vec3 wi;
    float distance;
  };
  std::vector<Query> queries;
  for (std::uint32_t i = 0; queries.size() < 1024; ++i) {
    const Receiver r = receiver(i);
    const std::uint32_t primitive = i % count;
    const Vec3 to = lamps.scene.meshes[0].positions[3 * primitive] - r.p;
    const Vec3 wi = to.normalized();
    if (lights.pdf_triangle(r.p, r.n, 0, primitive, wi, to.norm()) > 0.0f) {
      queries.push_back({r, primitive, wi, to.norm()});
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const Query& q = queries[i++ & 1023u];
    benchmark::DoNotOptimize(
        lights.pdf_triangle(q.receiver.p, q.receiver.n, 0, q.primitive, q.wi, q.distance));
  }
}

BENCHMARK(lights_sample<LightSelection::tree>)->Name("lights/sample")->Arg(1)->Arg(100)->Arg(10000);
BENCHMARK(lights_sample<LightSelection::power>)->Name("lights/sample_power")->Arg(10000);
BENCHMARK(lights_pdf)->Name("lights/pdf")->Arg(1)->Arg(100)->Arg(10000);
BENCHMARK(lights_build)->Name("lights/build")->Arg(10000)->Arg(50000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gatelight::renderer
