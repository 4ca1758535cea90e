// Nanoseconds per call of the BSDF, for the common materials. The directions come from an array that is too
// long for the branch predictor to learn.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/bsdf/bsdf.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {
namespace {

constexpr std::size_t kCount = 1 << 14;

struct Numbers {
  std::vector<Vec3> wo, wi;
  std::vector<float> u_lobe;
  std::vector<Vec2> u;
};

const Numbers& numbers() {
  static const Numbers result = [] {
    Numbers n;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Sampler sampler(SamplerKind::independent, 1, i, 0, 0);
      n.wo.push_back(sample_cosine_hemisphere(sampler.get_2d(0)));
      n.wi.push_back(sample_cosine_hemisphere(sampler.get_2d(1)));
      n.u_lobe.push_back(sampler.get_1d(2));
      n.u.push_back(sampler.get_2d(3));
    }
    return n;
  }();
  return result;
}

Bsdf make(const SurfaceMaterial& material, std::size_t i) {
  const Vec3 n = Vec3::UnitZ();
  return Bsdf(material, n, n, n, numbers().wo[i & (kCount - 1)], true);
}

void construct(benchmark::State& state, const SurfaceMaterial& material) {
  std::size_t i = 0;
  for (auto _ : state) {
    const Bsdf bsdf = make(material, i++);
    benchmark::DoNotOptimize(&bsdf);
    benchmark::ClobberMemory();
  }
}

std::vector<Bsdf> make_some(const SurfaceMaterial& material) {
  std::vector<Bsdf> result;
  for (std::size_t i = 0; i < 64; ++i) result.push_back(make(material, i));
  return result;
}

void evaluate(benchmark::State& state, const SurfaceMaterial& material) {
  const std::vector<Bsdf> bsdfs = make_some(material);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(bsdfs[i & 63].evaluate(numbers().wi[i & (kCount - 1)]));
    ++i;
  }
}

void sample(benchmark::State& state, const SurfaceMaterial& material) {
  const std::vector<Bsdf> bsdfs = make_some(material);
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i & (kCount - 1);
    benchmark::DoNotOptimize(bsdfs[i & 63].sample(numbers().u_lobe[k], numbers().u[k]));
    ++i;
  }
}

const bool bsdf_registered = [] {
  const auto add = [](const std::string& name, const SurfaceMaterial& material) {
    benchmark::RegisterBenchmark(("bsdf/construct/" + name).c_str(), construct, material);
    benchmark::RegisterBenchmark(("bsdf/evaluate/" + name).c_str(), evaluate, material);
    benchmark::RegisterBenchmark(("bsdf/sample/" + name).c_str(), sample, material);
  };
  SurfaceMaterial material;
  material.base_color = Color(0.8f, 0.6f, 0.4f);
  material.roughness = 0.5f;
  add("dielectric", material);
  material.metallic = 1.0f;
  add("metal", material);
  material.metallic = 0.0f;
  material.clearcoat = 1.0f;
  add("clearcoat", material);
  material.clearcoat = 0.0f;
  material.transmission = 1.0f;
  add("thin", material);
  material.thin_walled = false;
  add("rough_glass", material);
  material.roughness = 0.0f;
  add("smooth_glass", material);
  return true;
}();

}  // namespace
}  // namespace gatelight::renderer
