// Millions of triangles.

#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "renderer/film/memory_estimate.h"
#include "tests/extremes/pictures.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

/// Number of triangles: GATELIGHT_MANY_TRIANGLES, or a million.
std::size_t wanted() {
  const char* text = std::getenv("GATELIGHT_MANY_TRIANGLES");
  return text ? std::stoull(text) : 1'000'000;
}

/// Largest memory of this process in bytes since forget_peak().
double peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && status >> kib) return 1024.0 * kib;
  }
  return 0.0;
}
void forget_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << 5;
}

/// A square of 2 m made of about `triangles` triangles: Lambert under a white sky, so that it shows its
/// albedo.
SceneBuilder carpet(std::size_t triangles) {
  SceneBuilder builder;
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(0.5 * static_cast<double>(triangles))));
  const int m = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  PaddedVector<Vec3> p;
  std::vector<std::array<std::uint32_t, 3>> t;
  p.reserve((side + 1) * (side + 1));
  t.reserve(std::size_t{2} * side * side);
  const float step = 2.0f / static_cast<float>(side);
  for (std::uint32_t y = 0; y <= side; ++y) {
    for (std::uint32_t x = 0; x <= side; ++x) {
      p.emplace_back(-1.0f + step * static_cast<float>(x), -1.0f + step * static_cast<float>(y), 0.0f);
      if (x == side || y == side) continue;
      const std::uint32_t i = y * (side + 1) + x;
      t.push_back({i, i + 1, i + side + 2});
      t.push_back({i, i + side + 2, i + side + 1});
    }
  }
  builder.mesh(m, std::move(p), std::move(t));
  return builder;
}

RenderOptions picture() {
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.spp = 4;
  options.environment.constant = Color::Ones();
  options.camera.look_at = LookAt{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}};
  return options;
}

TEST(ManyTriangles, OneMeshFitsIntoTheEstimatedMemory) {
  forget_peak();
  const double before = peak_bytes();
  SceneBuilder builder = carpet(wanted());
  const std::size_t count = scene::count_triangles(builder.scene());
  const RenderOptions options = picture();
  const Rendered result = render(builder.scene(), options);
  const double used = peak_bytes() - before;
  const double estimate = static_cast<double>(estimate_memory(builder.scene(), options).total());
  EXPECT_NEAR(result.mean(), 0.5, 1e-3);
  EXPECT_LT(used, 1.25 * estimate);
  EXPECT_LT(used / static_cast<double>(count), 400.0);
}

TEST(ManyTriangles, InstancesShareTheMemoryOfTheirMesh) {
  forget_peak();
  const double before = peak_bytes();
  SceneBuilder builder = carpet(1000);
  scene::Scene& s = builder.scene();
  s.instances[0].baked = false;
  // Side by side: the carpet again, a 100th as wide.
  constexpr int kSide = 100;
  const scene::Instance one = s.instances[0];
  s.instances.clear();
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      scene::Instance instance = one;
      instance.transform = Eigen::Translation3f(-1.0f + 0.02f * (static_cast<float>(x) + 0.5f),
                                                -1.0f + 0.02f * (static_cast<float>(y) + 0.5f), 0.0f) *
                           Eigen::Scaling(0.01f);
      s.instances.push_back(instance);
    }
  }
  s.bounds = scene::compute_bounds(s);
  const Rendered result = render(s, picture());
  const double used = peak_bytes() - before;
  EXPECT_NEAR(result.mean(), 0.5, 1e-3);
  EXPECT_LT(used / static_cast<double>(s.instances.size()), 8000.0);
}

}  // namespace
}  // namespace gatelight::renderer
