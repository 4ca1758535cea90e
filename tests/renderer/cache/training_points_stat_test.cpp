// The distribution of the starts of training paths: surfaces by area, directions by cosine, candidates by how
// seldom they were trained.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "neural/layout/build_gate_layout.h"
#include "renderer/cache/scene_layout.h"
#include "renderer/cache/training_points.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using testing::ViewedWorld;

const double kSignificance = testing::sidak(1e-4, 20);
TEST(TrainingPointsStat, SurfacesAreChosenByAreaSidesEquallyAndDirectionsByCosine) {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  // A fan of triangles of different areas, one of them degenerate; both sides.
  PaddedVector<Vec3> fan{Vec3::Zero()};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const float a = 0.1f * static_cast<float>(i * i);
    fan.emplace_back(3.0f * std::cos(a), 2.0f * std::sin(a), 0.1f * static_cast<float>(i));
    if (i > 0) triangles.push_back({0, i, i + 1});
  }
  triangles.push_back({0, 3, 3});
  builder.mesh(matte, fan, triangles);
  // One side of a scaled and mirrored instance, and an instance without storage.
  builder.mesh(matte, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
  scene::Instance& mirrored = builder.scene().instances[1];
  mirrored.baked = false;
  mirrored.swaps_handedness = true;
  mirrored.transform.scale(Vec3(-1.5f, 2, 1));
  builder.quad(matte, Vec3(0, 0, 5), Vec3(9, 0, 0), Vec3(0, 9, 0));
  builder.scene().cameras.emplace_back();
  const ViewedWorld viewed(builder);
  const scene::Scene& scene = viewed.world.scene;
  RenderOptions options;
  options.sampler = SamplerKind::independent;
  options.cache.source = TrainingSource::surface;
  const std::vector<neural::Sides> sides{neural::Sides::both, neural::Sides::back, neural::Sides::none};
  const TrainingPoints points(viewed.world, viewed.camera, viewed.region, options, sides, nullptr);

  constexpr std::size_t kCount = 40000;
  TrainingStarts starts;
  RayCounts rays;
  points.choose(1, kCount, false, {}, starts, rays);
  ASSERT_EQ(starts.hits.size(), kCount);

  std::map<std::array<std::uint32_t, 3>, double> area;  // of instance, triangle, side
  double whole = 0.0;
  for (std::uint32_t i = 0; i < 2; ++i) {
    const auto count = static_cast<std::uint32_t>(scene.mesh_of(scene.instances[i]).triangles.size());
    for (std::uint32_t t = 0; t < count; ++t) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        const double a = scene::world_area(scene, scene.instances[i], t);
        area[{i, t, side}] = has_side(sides[i], side) ? a : 0.0;
        whole += area[{i, t, side}];
      }
    }
  }
  std::map<std::array<std::uint32_t, 3>, double> met;
  std::array<double, 4> quarter{};
  std::array<double, 10> cosine{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const Hit& hit = starts.hits[i];
    const Vec3 direction = starts.starts[i].sample.camera_ray.ray.direction;
    const Surface surface = viewed.world.surfaces.at(hit, direction, 0.0f, 0.5f);
    const std::uint32_t side = side_of(surface.front, hit.instance == 1);
    ++met[{hit.instance, hit.primitive, side}];
    // The four triangles between the middles of the edges have the same area.
    const float w = 1.0f - hit.u - hit.v;
    ++quarter[w > 0.5f ? 0 : hit.u > 0.5f ? 1 : hit.v > 0.5f ? 2 : 3];
    // The squared cosine of a cosine-weighted direction is uniform.
    const double c = static_cast<double>(-direction.dot(surface.geometric_normal));
    ++cosine[static_cast<std::size_t>(std::clamp(c * c * 10.0, 0.0, 9.0))];
  }
  std::vector<double> observed;
  std::vector<double> expected;
  for (const auto& [key, a] : area) {
    observed.push_back(met[key]);
    expected.push_back(kCount * a / whole);
    met.erase(key);
  }
  EXPECT_TRUE(met.empty()) << "nothing without storage is chosen";
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected), kSignificance));
  const std::array<double, 4> quarters{kCount / 4.0, kCount / 4.0, kCount / 4.0, kCount / 4.0};
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(quarter, quarters), kSignificance));
  std::array<double, 10> tenths;
  tenths.fill(kCount / 10.0);
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(cosine, tenths), kSignificance));
}

/// Four strips of a wall before the camera, a quarter of the picture each.
SceneBuilder four_strips() {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  const float half = 2.0f * std::tan(0.45f) * 64.0f / 48.0f;
  for (int i = 0; i < 4; ++i) {
    const float left = half * (0.5f * static_cast<float>(i) - 1.0f);
    builder.mesh(
        matte, {{left, -99, -2}, {left + 0.5f * half, -99, -2}, {left, 99, -2}, {left + 0.5f * half, 99, -2}},
        {{0, 1, 3}, {0, 3, 2}});
  }
  builder.scene().cameras.push_back(testing::view_from(Vec3::Zero(), Vec3(0, 0, -1)));
  return builder;
}

/// The last strip has no storage.
struct Strips {
  ViewedWorld viewed{four_strips()};
  std::vector<neural::Sides> sides = {neural::Sides::front, neural::Sides::front, neural::Sides::front,
                                      neural::Sides::none};
  neural::GateLayout layout =
      neural::build_gate_layout(WeldedMeshes(viewed.world.scene).layout(viewed.world.scene, sides), {});
};

/// The number of starts in each strip.
std::array<double, 4> chosen_strips(const Strips& strips, int candidates,
                                    std::array<std::uint32_t, 3> trained, std::size_t& made) {
  RenderOptions options;
  options.cache.candidates = candidates;
  const TrainingPoints points(strips.viewed.world, strips.viewed.camera, strips.viewed.region, options,
                              strips.sides, &strips.layout);
  std::vector<std::uint32_t> counts(strips.layout.triangle_count);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const neural::GateSurface& s = strips.layout.surfaces[neural::surface_index(i, 0)];
    for (std::uint32_t t = 0; t < 2; ++t) counts[s.first_triangle + t] = trained[i];
  }
  std::array<double, 4> met{};
  made = 0;
  for (std::uint64_t step = 0; step < 5; ++step) {
    TrainingStarts starts;
    RayCounts rays;
    points.choose(step, 4096, false, counts, starts, rays);
    made += starts.starts.size();
    for (std::size_t i = 0; i < starts.hits.size(); ++i) {
      const Ray& ray = starts.starts[i].sample.camera_ray.ray;
      EXPECT_EQ(starts.hits[i].instance,
                static_cast<std::uint32_t>(
                    std::clamp(std::floor(2.0f + 2.0f * (-2.0f * ray.direction.x() / ray.direction.z()) /
                                                     (2.0f * std::tan(0.45f) * 64.0f / 48.0f)),
                               0.0f, 3.0f)));
      ++met[starts.hits[i].instance];
    }
  }
  return met;
}

TEST(TrainingPointsStat, CandidatesAreChosenByHowSeldomTheyWereTrained) {
  const Strips strips;
  const std::array<std::uint32_t, 3> trained{400, 100, 1};
  // Counts beyond 512 are equal, and 0 counts as 1.
  for (const int candidates : {2, 3}) {
    std::size_t made = 0;
    const std::array<double, 4> met = chosen_strips(strips, candidates, trained, made);
    // All draws of `candidates` candidates with their probabilities. Those without storage are left out, and
    // where there is no other the start stays in its place.
    const std::array<double, 3> weight{1.0 / 400.0, 1.0 / 100.0, 1.0};
    std::array<double, 4> expected{};
    const int draws = candidates == 2 ? 16 : 64;
    for (int draw = 0; draw < draws; ++draw) {
      double sum = 0.0;
      for (int c = 0, rest = draw; c < candidates; ++c, rest /= 4)
        sum += rest % 4 < 3 ? weight[static_cast<std::size_t>(rest % 4)] : 0.0;
      for (int c = 0, rest = draw; c < candidates; ++c, rest /= 4) {
        if (sum > 0.0 && rest % 4 < 3)
          expected[static_cast<std::size_t>(rest % 4)] +=
              weight[static_cast<std::size_t>(rest % 4)] / sum / draws;
      }
      if (!(sum > 0.0)) {
        for (double& e : expected) e += 0.25 / draws;
      }
    }
    for (double& e : expected) e *= static_cast<double>(made);
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(met, expected), kSignificance))
        << met[0] << " " << met[1] << " " << met[2] << " " << met[3];
  }
}

TEST(TrainingPointsStat, EquallyTrainedCandidatesAreEquallyLikely) {
  const Strips strips;
  std::size_t made = 0;
  std::array<double, 4> met = chosen_strips(strips, 16, {0, 1, 0}, made);
  met[3] = 0.0;
  std::array<double, 4> expected{};
  for (std::size_t i = 0; i < 3; ++i) expected[i] = static_cast<double>(made) / 3.0;
  // Four thousand starts are left where all 16 candidates have no storage: 1e-10 of them.
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(met, expected), kSignificance));
}

}  // namespace
}  // namespace gatelight::renderer
