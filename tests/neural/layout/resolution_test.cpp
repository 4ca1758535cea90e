#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "neural/layout/build_gate_layout.h"
#include "tests/neural/layout/meshes.h"

namespace gatelight::neural {
namespace {

using testing::Mesh;

/// Right triangles with legs of these lengths, which share no vertices.
Mesh triangles_with_legs(const std::vector<float>& legs) {
  Mesh mesh;
  for (const float leg : legs) {
    const auto n = static_cast<std::uint32_t>(mesh.positions.size());
    const auto x = static_cast<float>(n);
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x + leg, 0, 0}, {x, leg, 0}});
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  return mesh;
}

GateOptions options_of(ResolutionRule rule) {
  GateOptions options{.stack = {kAdaptive}, .rule = rule, .cluster = false};
  return options;
}

std::uint32_t resolution_of(const GateLayout& layout, std::uint32_t instance) {
  return layout.levels[surface_index(instance, 0) * std::size_t{layout.stack}].resolution;
}

std::uint32_t uniform_resolution(const Mesh& mesh, float spacing, const std::array<float, 12>& transform) {
  GateOptions options = options_of(ResolutionRule::uniform);
  options.node_spacing = spacing;
  return resolution_of(build_gate_layout({{testing::view(mesh)}, {{0, transform, Sides::front}}}, options),
                       0);
}

constexpr std::array<float, 12> kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

TEST(Resolution, UniformIsTheRootOfTheAreaOverTheSpacingToNearest) {
  const Mesh mesh = triangles_with_legs({2});  // area 2
  for (const float spacing : {0.05f, 0.1f, 0.13f, 0.3f, 0.5f, 0.7f, 0.9f}) {
    const double expected = std::round(std::sqrt(2.0) / static_cast<double>(spacing));
    EXPECT_EQ(uniform_resolution(mesh, spacing, kIdentity), expected);
  }
}

TEST(Resolution, UniformWeighsTrianglesByTheirArea) {
  // Areas 8 and 32 times 0.5: the mean weighted by area is (4^2 + 8 * 0.5^2) / (4 + 8 * 0.5).
  const Mesh mesh = triangles_with_legs({std::sqrt(8.0f), 1, 1, 1, 1, 1, 1, 1, 1});
  EXPECT_EQ(uniform_resolution(mesh, 0.1f, kIdentity), std::round(std::sqrt(18.0 / 8.0) / 0.1));
}

TEST(Resolution, ALargeTriangleDoesNotMakeManySmallOnesFine) {
  std::vector<float> legs(999, 0.2f);  // areas 0.02
  legs.push_back(20.0f);               // and 200
  const double mean = (999 * 0.02 + 200.0) / 1000.0;
  EXPECT_EQ(uniform_resolution(triangles_with_legs(legs), 0.1f, kIdentity),
            std::round(std::sqrt(16.0 * mean) / 0.1))
      << "not that of the large triangle, which is 32";
}

TEST(Resolution, AreasAreThoseInWorldSpaceMirroredOrNot) {
  const Mesh mesh = triangles_with_legs({2, 1});
  const std::uint32_t once = uniform_resolution(mesh, 0.2f, kIdentity);
  EXPECT_EQ(uniform_resolution(mesh, 0.2f, testing::scaling(-1, 1, 1)), once);
  EXPECT_EQ(uniform_resolution(mesh, 0.2f, testing::translation(1e6f, -5, 3)), once);
  EXPECT_EQ(uniform_resolution(mesh, 0.2f, {0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0}), once);
  EXPECT_EQ(uniform_resolution(mesh, 0.4f, testing::scaling(2, 2, 2)), once);
  EXPECT_EQ(uniform_resolution(mesh, 0.4f, testing::scaling(4, -1, 7)), once);  // the mesh lies in z = 0
}

TEST(Resolution, DegenerateTrianglesDoNotCount) {
  Mesh mesh = triangles_with_legs({2});
  const std::uint32_t once = uniform_resolution(mesh, 0.2f, kIdentity);
  for (const std::array<std::uint32_t, 3>& t : {std::array<std::uint32_t, 3>{0, 0, 1}, {1, 1, 1}})
    mesh.triangles.push_back(t);
  EXPECT_EQ(uniform_resolution(mesh, 0.2f, kIdentity), once);

  // The paper's rule has a plain mean, which they would halve.
  const Mesh reference = triangles_with_legs({2});
  const SurfaceLayout scene = {{testing::view(mesh), testing::view(reference)}, {{0}, {1}}};
  const GateLayout layout = build_gate_layout(scene, options_of(ResolutionRule::paper));
  EXPECT_EQ(resolution_of(layout, 0), 32u);
  EXPECT_EQ(resolution_of(layout, 1), 32u);
}

TEST(Resolution, AnInstanceWithoutAreaHasResolutionOne) {
  const Mesh none = {{{1, 1, 1}, {2, 2, 2}}, {{0, 1, 0}, {1, 1, 1}}};
  const Mesh empty = {};
  const Mesh normal = triangles_with_legs({2});
  for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper}) {
    const SurfaceLayout scene = {{testing::view(none), testing::view(empty), testing::view(normal)},
                                 {{0},
                                  {1},
                                  {2, testing::scaling(1, 0, 0), Sides::front},
                                  {2, testing::scaling(0, 0, 0), Sides::front},
                                  {2}}};
    const GateLayout layout = build_gate_layout(scene, options_of(rule));
    for (std::uint32_t instance = 0; instance < 4; ++instance) EXPECT_EQ(resolution_of(layout, instance), 1u);
    EXPECT_GT(resolution_of(layout, 4), 1u);
    // The same where no instance has an area.
    const GateLayout flat = build_gate_layout({scene.meshes, {{0}, {1}}}, options_of(rule));
    EXPECT_EQ(resolution_of(flat, 0), 1u);
    EXPECT_EQ(flat.report.resolution_histogram[1], 2u);
  }
}

TEST(Resolution, PaperIsTheClampedQuadraticOfTheNormalisedMeanArea) {
  const std::vector<float> legs = {8, 7, 6, 4, 2, 1};
  std::vector<Mesh> meshes;
  SurfaceLayout scene;
  for (const float leg : legs) meshes.push_back(triangles_with_legs({leg, leg}));
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    scene.meshes.push_back(testing::view(meshes[m]));
    scene.instances.push_back({m});
  }
  for (const float scale : {0.25f, 1.0f, 5.0f, 1000.0f}) {
    GateOptions options = options_of(ResolutionRule::paper);
    options.resolution_scale = scale;
    const GateLayout layout = build_gate_layout(scene, options);
    for (std::uint32_t m = 0; m < meshes.size(); ++m) {
      const double area = legs[m] * legs[m] / 64.0;
      const double expected =
          std::clamp(std::round(32 * area * area * static_cast<double>(scale)), 1.0, 32.0);
      EXPECT_EQ(resolution_of(layout, m), expected);
    }
  }
}

TEST(Resolution, PaperNormalisesOnlyByInstancesWithStorage) {
  const Mesh small = triangles_with_legs({1});
  const Mesh large = triangles_with_legs({100});
  const SurfaceLayout scene = {{testing::view(small), testing::view(large)},
                               {{0}, {1, kIdentity, Sides::none}}};
  EXPECT_EQ(resolution_of(build_gate_layout(scene, options_of(ResolutionRule::paper)), 0), 32u);
}

TEST(Resolution, StaysBetweenOneAndTheMaximum) {
  const Mesh mesh = triangles_with_legs({2});
  EXPECT_EQ(uniform_resolution(mesh, 1e-30f, kIdentity), 32u);
  EXPECT_EQ(uniform_resolution(mesh, 1e30f, kIdentity), 1u);
  GateOptions options = options_of(ResolutionRule::uniform);
  options.node_spacing = 1e-3f;
  options.max_resolution = 7;
  EXPECT_EQ(resolution_of(build_gate_layout(testing::one_instance(mesh), options), 0), 7u);
}

TEST(Resolution, LevelsOfTheStackAreAdaptiveOrFixed) {
  const Mesh mesh = triangles_with_legs({2});
  GateOptions options = options_of(ResolutionRule::uniform);
  options.node_spacing = 0.2f;
  options.stack = {3, kAdaptive, 1, 64};
  const GateLayout layout = build_gate_layout(testing::one_instance(mesh), options);
  ASSERT_EQ(layout.stack, 4u);
  EXPECT_EQ(layout.levels[0].resolution, 3u);
  EXPECT_EQ(layout.levels[1].resolution, 7u);
  EXPECT_EQ(layout.levels[2].resolution, 1u);
  EXPECT_EQ(layout.levels[3].resolution, 64u);
  EXPECT_EQ(layout.report.resolution_histogram[3], 1u);
}

}  // namespace
}  // namespace gatelight::neural
