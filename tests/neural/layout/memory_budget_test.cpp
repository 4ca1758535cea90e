#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <string>

#include "base/errors.h"
#include "neural/layout/build_gate_layout.h"
#include "neural/layout/mesh_colors.h"
#include "tests/neural/layout/meshes.h"
#include "tests/support/messages.h"

namespace gatelight::neural {
namespace {

using testing::Mesh;

constexpr std::uint64_t kMegabyte = 1000000;

/// Returns the least number of bytes, which the message of a refused budget names.
std::uint64_t least_bytes(const SurfaceLayout& scene, GateOptions options) {
  options.memory_budget = 1;
  const ErrorParts parts = tests::refused_parts<BadConfiguration>([&] { build_gate_layout(scene, options); });
  tests::expect_parts(parts, {"cache-memory", "0.00000095", "MiB"});
  std::smatch match;
  const bool named = std::regex_search(parts.expected, match, std::regex("([0-9.]+)$"));
  return named ? static_cast<std::uint64_t>(std::ceil(std::stod(match[1]) * 1048576.0)) : 0;
}

/// Spheres of several tessellations and sizes, some with both sides, and a floor of two large triangles.
struct Scene {
  std::vector<Mesh> meshes = {testing::sphere(16, 1), testing::sphere(48, 0.5f), testing::sphere(128, 1),
                              testing::grid(1, 20)};
  SurfaceLayout surfaces;
  Scene() {
    for (const Mesh& mesh : meshes) surfaces.meshes.push_back(testing::view(mesh));
    for (std::uint32_t i = 0; i < 20; ++i)
      surfaces.instances.push_back({i % 3, testing::translation(static_cast<float>(i), 0, 1),
                                    i % 4 == 0 ? Sides::both : Sides::front});
    surfaces.instances.push_back({3});
  }
};

TEST(MemoryBudget, IsMetAndUsed) {
  const Scene scene;
  GateOptions options;
  for (const auto& stack : {std::vector<std::uint32_t>{kAdaptive, 1},
                            {kAdaptive, adaptive_part(4), adaptive_part(16)},
                            {1, adaptive_part(64)}}) {
    options.stack = stack;
    for (std::uint64_t budget = 3000; budget < 100 * kMegabyte; budget *= 3) {
      options.memory_budget = budget;
      const GateLayout layout = build_gate_layout(scene.surfaces, options);
      EXPECT_LE(testing::feature_bytes(layout, options), budget);
      if (budget > 100000 && stack[0] == kAdaptive) {
        EXPECT_GE(testing::feature_bytes(layout, options), 0.5 * budget);
      }
    }
  }
}

TEST(MemoryBudget, TheFinestLayoutIsTakenWhereItFits) {
  const Scene scene;
  GateOptions options{.memory_budget = 10000 * kMegabyte};
  const GateLayout layout = build_gate_layout(scene.surfaces, options);
  EXPECT_EQ(layout.report.resolution_histogram[options.max_resolution], 21u);
}

TEST(MemoryBudget, TheReportedSpacingGivesTheSameLayout) {
  const Scene scene;
  for (const std::uint64_t budget : {100000, 1000000, 10000000}) {
    GateOptions options{.memory_budget = budget};
    const GateLayout layout = build_gate_layout(scene.surfaces, options);
    options.memory_budget = 0;
    options.node_spacing = layout.report.node_spacing;
    testing::expect_same_tables(layout, build_gate_layout(scene.surfaces, options));
  }
}

TEST(MemoryBudget, WithoutClustersTheNextFinerSpacingWouldNotFit) {
  const Scene scene;
  for (const NodeStorage storage : {NodeStorage::shared, NodeStorage::per_triangle})
    for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper}) {
      GateOptions options{
          .rule = rule, .storage = storage, .cluster = false, .memory_budget = 40 * kMegabyte};
      const GateLayout layout = build_gate_layout(scene.surfaces, options);
      EXPECT_LE(testing::feature_bytes(layout, options), options.memory_budget);
      GateOptions finer = options;
      finer.memory_budget = 0;
      finer.node_spacing = std::nextafter(layout.report.node_spacing, 0.0f);
      finer.resolution_scale = std::nextafter(layout.report.resolution_scale, 1e30f);
      EXPECT_GT(testing::feature_bytes(build_gate_layout(scene.surfaces, finer), finer),
                options.memory_budget);
    }
}

TEST(MemoryBudget, HalfTheBytesOfAFeatureGiveAboutTwiceTheNodes) {
  const Scene scene;
  GateOptions options{.memory_budget = kMegabyte};
  const GateLayout full = build_gate_layout(scene.surfaces, options);
  options.bytes_per_feature = 2;
  const GateLayout half = build_gate_layout(scene.surfaces, options);
  EXPECT_LE(testing::feature_bytes(half, options), kMegabyte);
  EXPECT_NEAR(half.node_count, 2.0 * full.node_count, 0.3 * full.node_count);
}

TEST(MemoryBudget, OneMegabyteHoldsAMillionSmallTriangles) {
  Mesh mesh = testing::grid(708, 10);
  for (Float3& p : mesh.positions) p[2] = std::sin(p[0]) * std::cos(p[1]);
  ASSERT_GE(mesh.triangles.size(), 1000000u);
  GateOptions options;
  for (const std::uint64_t budget : {kMegabyte, 16 * kMegabyte}) {
    options.memory_budget = budget;
    const GateLayout layout = build_gate_layout(testing::one_instance(mesh), options);
    EXPECT_LE(testing::feature_bytes(layout, options), budget);
    EXPECT_GE(testing::feature_bytes(layout, options), 0.95 * budget);
    EXPECT_EQ(layout.report.clustered_surfaces, 1u);
  }
}

/// Instances all over a cube of 100^3, every other one with both sides.
SurfaceLayout many_instances(const Mesh& mesh, std::uint32_t count) {
  SurfaceLayout scene = {{testing::view(mesh)}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto coordinate = [&](std::uint32_t c) { return static_cast<float>(100 * testing::uniform(c, i)); };
    scene.instances.push_back({0, testing::translation(coordinate(0), coordinate(1), coordinate(2)),
                               i % 2 == 0 ? Sides::both : Sides::front});
  }
  return scene;
}

TEST(MemoryBudget, ManyInstancesFirstMergeNormalsThenShareClusters) {
  const Mesh mesh = testing::sphere(8, 0.5f);
  const SurfaceLayout scene = many_instances(mesh, 1000);  // 1500 sides
  GateOptions options;
  const auto nodes_per_side = [&](std::uint64_t nodes_in_budget) {
    options.memory_budget = nodes_in_budget * options.features * options.bytes_per_feature;
    const GateLayout layout = build_gate_layout(scene, options);
    EXPECT_LE(layout.node_count, nodes_in_budget);
    EXPECT_GE(layout.node_count, 0.8 * nodes_in_budget);
    EXPECT_EQ(layout.report.clustered_surfaces, 1500u);
    std::set<std::uint32_t> bases;
    for (const GateSurfaceLevel& level : layout.levels) bases.insert(level.vertex_base);
    return bases.size();
  };
  // Two levels: six clusters a side are 18000 nodes, one is 3000. Then all instances share a block for each
  // side and level.
  EXPECT_EQ(nodes_per_side(25000), 3000u);
  EXPECT_EQ(nodes_per_side(8000), 3000u);
  EXPECT_EQ(nodes_per_side(2500), 4u);
  EXPECT_EQ(nodes_per_side(600), 4u);
}

TEST(MemoryBudget, ACapDoesNotChangeALayoutThatFits) {
  const Scene scene;
  for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper, ResolutionRule::fixed})
    for (const bool cluster : {false, true}) {
      GateOptions options{.stack = {kAdaptive, adaptive_part(4), 1},
                          .rule = rule,
                          .node_spacing = 0.3f,
                          .resolution_scale = 0.7f,
                          .cluster = cluster};
      const GateLayout wanted = build_gate_layout(scene.surfaces, options);
      options.memory_budget = testing::feature_bytes(wanted, options);
      options.budget_is_cap = true;
      const GateLayout layout = build_gate_layout(scene.surfaces, options);
      testing::expect_same_tables(layout, wanted);
      EXPECT_EQ(layout.report.node_spacing, options.node_spacing);
      EXPECT_EQ(layout.report.resolution_scale, options.resolution_scale);
    }
}

TEST(MemoryBudget, ACapMakesALayoutNoCoarserThanNecessary) {
  const Scene scene;
  for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper})
    for (const bool cluster : {false, true})
      for (const float share : {0.99f, 0.9f, 0.3f, 0.03f}) {
        GateOptions options{.stack = {kAdaptive, adaptive_part(4), adaptive_part(16)},
                            .rule = rule,
                            .node_spacing = 0.05f,
                            .resolution_scale = 0.7f,
                            .cluster = cluster};
        const GateLayout wanted = build_gate_layout(scene.surfaces, options);
        options.memory_budget =
            static_cast<std::uint64_t>(share * static_cast<float>(testing::feature_bytes(wanted, options)));
        if (options.memory_budget < least_bytes(scene.surfaces, options)) continue;
        options.budget_is_cap = true;
        const GateLayout layout = build_gate_layout(scene.surfaces, options);
        EXPECT_LE(testing::feature_bytes(layout, options), options.memory_budget);
        GateOptions finer = options;
        finer.memory_budget = 0;
        if (rule == ResolutionRule::uniform) {
          EXPECT_GT(layout.report.node_spacing, options.node_spacing);
          finer.node_spacing = layout.report.node_spacing / 1.02f;
        } else {
          EXPECT_LT(layout.report.resolution_scale, options.resolution_scale);
          finer.resolution_scale = layout.report.resolution_scale * 1.02f;
        }
        EXPECT_GT(testing::feature_bytes(build_gate_layout(scene.surfaces, finer), finer),
                  options.memory_budget);
      }
}

TEST(MemoryBudget, ACapBelowTheCoarsestLayoutIsIgnored) {
  const Scene scene;
  for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper, ResolutionRule::fixed})
    for (const bool cluster : {false, true})
      for (const float spacing : {0.1f, 1e30f, std::numeric_limits<float>::max()}) {
        GateOptions options{.rule = rule, .node_spacing = spacing, .cluster = cluster};
        const GateLayout wanted = build_gate_layout(scene.surfaces, options);
        options.memory_budget = 100;
        options.budget_is_cap = true;
        testing::expect_same_tables(build_gate_layout(scene.surfaces, options), wanted);
      }
}

TEST(MemoryBudget, LevelsOfAllInstancesHaveClustersOfTheirOwn) {
  // Beside the spheres floors that are large enough for R > 1: the adaptive level of the spheres and the
  // constant one of all have the same cells, but not the same vertices.
  const Mesh mesh = testing::sphere(8, 0.5f);
  const Mesh floor = testing::grid(1, 1000);
  SurfaceLayout scene = many_instances(mesh, 1000);
  scene.meshes.push_back(testing::view(floor));
  scene.instances.push_back({1, testing::translation(0, 0, -1)});
  scene.instances.push_back({1, testing::translation(0, 0, 101)});
  for (SurfaceInstance& instance : scene.instances) instance.sides = Sides::both;
  GateOptions options{.stack = {kAdaptive, 1, adaptive_part(4)}};
  for (const std::uint64_t nodes : {400, 1000, 2500}) {
    options.memory_budget = nodes * options.features * options.bytes_per_feature;
    const GateLayout layout = build_gate_layout(scene, options);
    EXPECT_LE(layout.node_count, nodes);
    EXPECT_GE(layout.node_count, 0.7 * nodes);
    const GateSurfaceLevel* const sphere = layout.levels.data();
    const GateSurfaceLevel* const back = layout.levels.data() + 3 * 2001;  // of the floor below
    EXPECT_EQ(sphere[0].resolution, 1u);
    EXPECT_GT(back[0].resolution, 1u);
    EXPECT_EQ(back[1].vertex_base, layout.levels[3 * 1 + 1].vertex_base);  // of the first sphere's back
    testing::expect_all_nodes_reached(layout);
  }
}

TEST(MemoryBudget, CellsOfDifferentScalesAreNotMerged) {
  const Mesh mesh = testing::sphere(8, 0.5f);
  SurfaceLayout scene = many_instances(mesh, 100);
  const std::uint64_t least = least_bytes(scene, {});
  for (std::size_t i = 0; i < 100; ++i) scene.instances[i].spacing_scale = i % 3 == 0 ? 1.0f : 4.0f;
  EXPECT_EQ(least_bytes(scene, {}), 2 * least);
  GateOptions options;
  for (const std::uint64_t budget : {2 * least, 8 * least}) {
    options.memory_budget = budget;
    const GateLayout layout = build_gate_layout(scene, options);
    std::array<std::set<std::uint32_t>, 2> nodes;
    for (std::uint32_t i = 0; i < 100; ++i)
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        nodes[i % 3 == 0].insert(node_index(layout, 2 * i, 0, t, {1, 0, 0}));
    for (const std::uint32_t node : nodes[0]) EXPECT_FALSE(nodes[1].contains(node));
  }
}

TEST(MemoryBudget, TheLeastBudgetIsNamedAndAccepted) {
  const Scene scene;
  std::vector<GateOptions> all(8);
  all[0].cluster = false;
  all[1].storage = NodeStorage::per_triangle;
  all[2].rule = ResolutionRule::paper;
  all[3].rule = ResolutionRule::fixed;
  all[4].rule = ResolutionRule::fixed;
  all[4].storage = NodeStorage::per_triangle;
  all[5].stack = {kAdaptive, 4};
  all[6] = {};  // clusters: a node for each normal, side and level
  all[7].stack = {kAdaptive, adaptive_part(4), 4, adaptive_part(16)};
  for (GateOptions options : all) {
    const std::uint64_t least = least_bytes(scene.surfaces, options);
    ASSERT_GT(least, 0u);
    options.memory_budget = least;
    EXPECT_EQ(testing::feature_bytes(build_gate_layout(scene.surfaces, options), options), least);
    options.memory_budget = least - 1;
    EXPECT_THROW(build_gate_layout(scene.surfaces, options), BadConfiguration);
  }
  EXPECT_LE(least_bytes(scene.surfaces, {}), 2u * 2 * 6 * 32);
}

}  // namespace
}  // namespace gatelight::neural
