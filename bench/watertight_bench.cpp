// watertight/{robust,fast}/{box,ball}/{any,edges}: rays inside a closed mesh, in any direction or towards
// points of its edges. `leaks` counts rays that meet nothing, in a thousand million.

#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "bench/bare_embree.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"

namespace gatelight::bench {
namespace {

constexpr int kRows = 32;
constexpr std::size_t kChunk = 1 << 20;

/// kRows x kRows squares of two triangles; `place` maps [0, 1]^2 to points of the surface.
template <class Place>
void add_grid(scene::Mesh& mesh, const Place& place) {
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kRows; ++x) {
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        mesh.positions.push_back(
            place(static_cast<float>(x + dx) / (kRows), static_cast<float>(y + dy) / kRows));
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
}

/// A closed mesh around the origin, turned, so that no edge lies along an axis.
scene::Scene closed(const std::string& shape) {
  const Eigen::Matrix3f turn =
      Eigen::AngleAxisf(0.7f, Vec3(0.36f, 0.48f, 0.8f).normalized()).toRotationMatrix();
  scene::Scene scene;
  scene::Mesh& mesh = scene.meshes.emplace_back();
  if (shape == "ball") {
    add_grid(mesh, [&](float u, float v) -> Vec3 {
      // The seam and the poles are the same floats from both sides.
      const float phi = u == 1.0f ? 0.0f : 2.0f * std::numbers::pi_v<float> * u;
      const float sine = v == 1.0f ? 0.0f : std::sin(std::numbers::pi_v<float> * v);
      return turn * Vec3(sine * std::cos(phi), std::cos(std::numbers::pi_v<float> * v), sine * std::sin(phi));
    });
  } else {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0f, 1.0f}) {
        add_grid(mesh, [&](float u, float v) -> Vec3 {
          Vec3 p;
          p[axis] = side;
          p[(axis + 1) % 3] = 2.0f * u - 1.0f;
          p[(axis + 2) % 3] = 2.0f * v - 1.0f;
          return turn * p;
        });
      }
    }
  }
  scene.instances.push_back({.mesh = 0, .baked = true});
  return scene;
}

/// A ray from a random point within, at least 0.4 from the surface.
renderer::Ray ray_within(const scene::Mesh& mesh, bool to_edges, std::uint32_t index) {
  const renderer::Sampler sampler(renderer::SamplerKind::independent, 1, index, 0, 0);
  renderer::Ray ray;
  ray.origin = 0.5f * renderer::sample_uniform_sphere(sampler.get_2d(0)) * sampler.get_1d(2);
  ray.t_max = kInfinity;
  if (!to_edges) {
    ray.direction = renderer::sample_uniform_sphere(sampler.get_2d(3));
    return ray;
  }
  const auto count = static_cast<float>(mesh.triangles.size());
  const auto& triangle = mesh.triangles[static_cast<std::size_t>(sampler.get_1d(3) * count)];
  const float along = sampler.get_1d(4);
  const Vec3 target = mesh.positions[triangle[0]] * (1.0f - along) + mesh.positions[triangle[2]] * along;
  ray.direction = (target - ray.origin).normalized();
  return ray;
}

void leaks(benchmark::State& state, const std::string& shape, bool to_edges, Watertight watertight) {
  const scene::Scene scene = closed(shape);
  const BareEmbree bare(scene, watertight);
  std::vector<renderer::Ray> rays(kChunk);
  std::uint32_t next = 0;
  double missed = 0.0;
  double traced = 0.0;
  for (auto _ : state) {
    for (renderer::Ray& ray : rays) ray = ray_within(scene.meshes[0], to_edges, next++);
    missed += static_cast<double>(bare.trace_packets(rays, false, false));
    traced += static_cast<double>(rays.size());
  }
  state.counters["leaks"] = 1e9 * missed / traced;
  state.counters["rays"] = traced;
}

const int watertight_registered = [] {
  for (const std::string shape : {"box", "ball"}) {
    for (const auto& [name, watertight] :
         {std::pair{"robust", Watertight::robust}, std::pair{"fast", Watertight::fast}}) {
      for (const bool to_edges : {false, true}) {
        benchmark::RegisterBenchmark(
            (std::string("watertight/") + name + "/" + shape + (to_edges ? "/edges" : "/any")).c_str(),
            [=, chosen = watertight](benchmark::State& s) { leaks(s, shape, to_edges, chosen); })
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  return 0;
}();

}  // namespace
}  // namespace gatelight::bench
