#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "neural/layout/build_gate_layout.h"
#include "neural/layout/mesh_colors.h"
#include "tests/neural/layout/meshes.h"

namespace gatelight::neural {
namespace {

using testing::Mesh;

/// Corner c of triangle t in a level of surface 0: a vertex or a cluster.
std::uint32_t corner(const GateLayout& layout, std::uint32_t t, std::uint32_t c, std::uint32_t level = 0) {
  const GateSurface& s = layout.surfaces[0];
  return layout
      .topology[s.topology_offset + std::size_t{t} * s.topology_stride + layout.levels[level].corners + c];
}

using Stack = std::vector<std::uint32_t>;

GateLayout layout_of(const SurfaceLayout& scene, float spacing, const Stack& stack = {kAdaptive, 1}) {
  GateOptions options{.stack = stack, .node_spacing = spacing};
  return build_gate_layout(scene, options);
}

TEST(Clusters, AreTheVerticesOfACellThatFaceTheSameWay) {
  const Mesh mesh = testing::sphere(128, 1);
  const float spacing = 0.3f;
  const float c = std::cos(0.5f);
  const float s = std::sin(0.5f);
  struct Case {
    std::array<float, 12> to_world;
    std::array<float, 9> normals_to_world;  // cofactors
  };
  const std::array<Case, 3> cases = {
      {{{c, s, 0, -s, c, 0, 0, 0, 1, 0.3f, -7, 2.2f}, {c, s, 0, -s, c, 0, 0, 0, 1}},
       {{c, s, 0, -s, c, 0, 0, 0, -1, 5, 5, 5}, {-c, -s, 0, s, -c, 0, 0, 0, 1}},
       {{1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0, 0, 1}, {1, 0, 0, 0, 0.5f, 0, 0, 0, 2}}}};
  for (const auto& [to_world, normals_to_world] : cases) {
    const GateLayout layout = layout_of({{testing::view(mesh)}, {{0, to_world, Sides::front}}}, spacing,
                                        {adaptive_part(3), kAdaptive, 1, adaptive_part(12)});
    ASSERT_EQ(layout.report.clustered_surfaces, 1u);
    const std::array<double, 4> divisors = {3, 1, 1, 12};
    const std::array<std::size_t, 4> at_least = {40, 200, 200, 6};
    for (std::uint32_t level = 0; level < 4; ++level) {
      using Key = std::tuple<double, double, double, int>;
      std::map<Key, std::set<std::uint32_t>> found;
      std::map<std::uint32_t, std::set<Key>> keys;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (std::uint32_t k = 0; k < 3; ++k) {
          const Float3& p = mesh.positions[mesh.triangles[t][k]];  // also the sphere's normal there
          std::array<double, 3> normal = {0, 0, 0};
          std::array<double, 3> cell;
          for (std::size_t r = 0; r < 3; ++r) {
            double place = to_world[9 + r];
            for (std::size_t i = 0; i < 3; ++i) {
              place += double{to_world[3 * i + r]} * p[i];
              normal[r] += double{normals_to_world[3 * i + r]} * p[i];
            }
            // Cells of coarser levels consist of cells of the finest level.
            const double finest = std::floor(place / (0.5 * spacing) + 0.3819660112501051);
            cell[r] =
                std::floor((finest + std::floor(0.3819660112501051 * divisors[level])) / divisors[level]);
          }
          std::array<double, 3> sorted = {std::abs(normal[0]), std::abs(normal[1]), std::abs(normal[2])};
          const auto axis = static_cast<int>(std::ranges::max_element(sorted) - sorted.begin());
          std::ranges::sort(sorted);
          // Undecided between two axes, because the mesh's normals are not exactly the sphere's.
          if (sorted[1] > 0.93 * sorted[2]) continue;
          const Key key = {cell[0], cell[1], cell[2], 2 * axis + (normal[axis] < 0)};
          found[key].insert(corner(layout, t, k, level));
          keys[corner(layout, t, k, level)].insert(key);
        }
      for (const auto& [key, clusters] : found) EXPECT_EQ(clusters.size(), 1u);
      for (const auto& [cluster, its_keys] : keys) EXPECT_EQ(its_keys.size(), 1u);
      EXPECT_GT(found.size(), at_least[level]);
    }
  }
}

/// Returns the number of nodes of a level of surface 0 that has no edges.
std::uint32_t corner_count(const GateLayout& layout, const Mesh& mesh, std::uint32_t level) {
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t c = 0; c < 3; ++c) count = std::max(count, corner(layout, t, c, level) + 1);
  return count;
}

TEST(Clusters, ACoarserLevelHasFewerNodes) {
  const Mesh mesh = testing::grid(160, 16);
  const GateLayout layout =
      layout_of(testing::one_instance(mesh), 0.5f, {kAdaptive, adaptive_part(4), adaptive_part(16)});
  const std::array<std::uint32_t, 3> nodes = {corner_count(layout, mesh, 0), corner_count(layout, mesh, 1),
                                              corner_count(layout, mesh, 2)};
  // Cells of 0.25, 1 and 4 units, and cells that reach beyond the rim.
  EXPECT_NEAR(nodes[0], 65 * 65, 65);
  EXPECT_NEAR(nodes[1], 17 * 17, 17);
  EXPECT_NEAR(nodes[2], 5 * 5, 5);
  EXPECT_EQ(nodes[0] + nodes[1] + nodes[2], layout.node_count);
}

TEST(Clusters, OnlyLevelsWithResolutionOneWhoseCellsMergeVerticesHaveClusters) {
  // Triangles with legs of 1, and R of 2, 1 and 1 with cells of 0.2, 0.6 and 2.4.
  const Mesh mesh = testing::grid(12, 12);
  const GateLayout layout = layout_of(testing::one_instance(mesh, Sides::both), 0.4f,
                                      {kAdaptive, adaptive_part(3), adaptive_part(12), 1});
  const std::array<std::uint32_t, 4> resolutions = {2, 1, 1, 1};
  const std::array<std::uint32_t, 4> corners = {0, 0, 6, 0};
  for (std::uint32_t l = 0; l < 8; ++l) {
    EXPECT_EQ(layout.levels[l].resolution, resolutions[l % 4]);
    EXPECT_EQ(layout.levels[l].corners, corners[l % 4]);
  }
  EXPECT_EQ(layout.surfaces[0].topology_stride, 9u);
  EXPECT_EQ(layout.surfaces[1].topology_offset, layout.surfaces[0].topology_offset);
  const std::uint32_t clusters = corner_count(layout, mesh, 2);
  EXPECT_LT(clusters, 7u * 7u);
  EXPECT_EQ(layout.report.cluster_nodes, 2 * clusters);
  EXPECT_EQ(layout.report.vertex_nodes, 2 * 3 * mesh.positions.size());
  EXPECT_EQ(layout.report.edge_nodes, 2 * testing::count_edges(mesh));
  // Edges and vertices are as in a layout without clusters.
  const GateLayout plain =
      layout_of(testing::one_instance(mesh, Sides::both), 0.4f, {kAdaptive, adaptive_part(3)});
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t w = 0; w < 6; ++w) ASSERT_EQ(layout.topology[9 * t + w], plain.topology[6 * t + w]);
}

TEST(Clusters, RowsHaveNoUnusedWords) {
  struct Case {
    float spacing;
    Stack stack;
    std::uint32_t stride;
  };
  const Mesh mesh = testing::grid(40, 10);  // legs of 0.25
  for (const auto& [spacing, stack, stride] : {
           Case{0.1f, {kAdaptive}, 6},                                            // vertices, edges
           Case{0.25f, {kAdaptive, 1}, 3},                                        // vertices
           Case{1, {kAdaptive, 1}, 3},                                            // clusters
           Case{1, {1, kAdaptive, adaptive_part(1)}, 3},                          // the same cells
           Case{1, {kAdaptive, adaptive_part(4), 1}, 6},                          // two sizes
           Case{1, {kAdaptive, adaptive_part(4), adaptive_part(16)}, 9},          // three
           Case{0.25f, {kAdaptive, adaptive_part(4), adaptive_part(16), 1}, 9},   // vertices, two sizes
           Case{0.1f, {kAdaptive, adaptive_part(16), adaptive_part(64), 2}, 12},  // all
           Case{1, {2, kAdaptive}, 9},
       }) {
    const GateLayout layout = layout_of(testing::one_instance(mesh), spacing, stack);
    EXPECT_EQ(layout.surfaces[0].topology_stride, stride);
    EXPECT_EQ(layout.topology.size(), stride * mesh.triangles.size() + kTopologyPadding);
    std::set<std::uint32_t> read;
    for (const GateSurfaceLevel& level : std::span(layout.levels).first(layout.stack)) {
      read.insert(level.corners);
      if (level.resolution > 1) read.insert(kTopologyEdges);
    }
    EXPECT_EQ(3 * read.size(), stride);
    EXPECT_EQ(*read.rbegin() + 3, stride);
  }
}

TEST(Clusters, InstancesWithoutClustersShareTheTableOfTheirMesh) {
  const Mesh mesh = testing::grid(40, 10);
  SurfaceLayout scene = testing::one_instance(mesh);
  for (const float scale : {1.0f, 4.0f, 0.1f, 4.0f, 0.1f})
    scene.instances.push_back({0, testing::scaling(scale, scale, scale), Sides::front});
  const GateLayout layout = layout_of(scene, 0.25f);
  std::vector<std::uint32_t> offsets;
  for (std::size_t s = 0; s < layout.surfaces.size(); s += 2)
    offsets.push_back(layout.surfaces[s].topology_offset);
  EXPECT_EQ(offsets[1], offsets[0]);
  EXPECT_EQ(offsets[2], offsets[0]);
  EXPECT_EQ(offsets[4], offsets[0]);
  EXPECT_EQ(std::set<std::uint32_t>(offsets.begin(), offsets.end()).size(), 3u);
  EXPECT_EQ(layout.topology.size(), (6 + 3 + 3) * mesh.triangles.size() + kTopologyPadding);
}

TEST(Clusters, AreNumberedInTheOrderOfTheirVertices) {
  const Mesh mesh = testing::sphere(64, 1);
  const GateLayout layout = layout_of(testing::one_instance(mesh), 0.5f);
  std::vector<std::uint32_t> cluster(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t c = 0; c < 3; ++c) cluster[mesh.triangles[t][c]] = corner(layout, t, c);
  std::uint32_t next = 0;
  for (const std::uint32_t number : cluster) {
    ASSERT_LE(number, next);
    if (number == next) ++next;
  }
  EXPECT_EQ(2 * next, layout.node_count);
  EXPECT_EQ(layout.report.cluster_nodes, layout.node_count);
}

TEST(Clusters, RoundingErrorsAtRoundCoordinatesAndAnglesDoNotSplitClusters) {
  // A floor at the height of a multiple of the cell, and a roof of 45 degrees, without and with noise.
  for (const float slope : {0.0f, 1.0f}) {
    std::vector<std::uint32_t> nodes;
    for (const float noise : {0.0f, 1e-5f}) {
      Mesh mesh = testing::grid(100, 10);
      for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        mesh.positions[v][2] =
            slope * mesh.positions[v][0] + noise * static_cast<float>(testing::uniform(1, v) - 0.5);
      nodes.push_back(layout_of(testing::one_instance(mesh), 1.0f).node_count);
    }
    EXPECT_EQ(nodes[0], nodes[1]);
  }
}

TEST(Clusters, BothSidesShareATableAndHaveSeparateBases) {
  const Mesh mesh = testing::sphere(64, 1);
  const GateLayout layout = layout_of(testing::one_instance(mesh, Sides::both), 0.5f);
  const GateLayout front = layout_of(testing::one_instance(mesh), 0.5f);
  EXPECT_EQ(layout.report.clustered_surfaces, 2u);
  EXPECT_EQ(front.report.clustered_surfaces, 1u);
  EXPECT_EQ(layout.surfaces[0].topology_offset, layout.surfaces[1].topology_offset);
  EXPECT_TRUE(layout.topology == front.topology);
  EXPECT_EQ(layout.node_count, 2 * front.node_count);
  std::set<std::uint32_t> bases;
  for (const GateSurfaceLevel& level : layout.levels) bases.insert(level.vertex_base);
  EXPECT_EQ(bases.size(), 4u);
}

TEST(Clusters, InstancesInOneCellShareNoClusters) {
  const Mesh mesh = testing::sphere(32, 0.1f);
  SurfaceLayout scene = testing::one_instance(mesh);
  scene.instances.resize(3, scene.instances[0]);
  const GateLayout layout = layout_of(scene, 1.0f);
  const GateLayout alone = layout_of(testing::one_instance(mesh), 1.0f);
  EXPECT_EQ(layout.report.clustered_surfaces, 3u);
  EXPECT_EQ(layout.node_count, 3 * alone.node_count);
  EXPECT_LE(alone.node_count, 2u * 6);
}

TEST(Clusters, AreMadeOnlyWhereTheOptionsAllowThem) {
  const Mesh mesh = testing::sphere(64, 1);
  const auto clustered = [&](const std::function<void(GateOptions&)>& change) {
    GateOptions options{.node_spacing = 0.5f};
    change(options);
    return build_gate_layout(testing::one_instance(mesh), options).report.clustered_surfaces;
  };
  EXPECT_EQ(clustered([](GateOptions&) {}), 1u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.stack = {1}; }), 1u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.cluster = false; }), 0u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.rule = ResolutionRule::paper; }), 0u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.rule = ResolutionRule::fixed; }), 0u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.storage = NodeStorage::per_triangle; }), 0u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.stack = {2, 3}; }), 0u);
  EXPECT_EQ(clustered([](GateOptions& o) { o.stack = {2, kAdaptive}; }), 1u);
}

TEST(Clusters, HugeAndTinyCoordinatesAndSpacingsGiveValidClusters) {
  const Mesh mesh = testing::sphere(32, 1);
  for (const float scale : {1e-30f, 1.0f, 1e30f})
    for (const float shift : {0.0f, 1e30f, -3e38f})
      for (const float spacing : {1e-38f, 1e-20f, 1.0f, 1e20f, 1e38f}) {
        std::array<float, 12> transform = testing::scaling(scale, scale, scale);
        transform[9] = shift;
        const GateLayout layout = layout_of({{testing::view(mesh)}, {{0, transform, Sides::front}}}, spacing);
        EXPECT_GE(layout.node_count, 2u);
        for (const std::uint32_t word : layout.topology) ASSERT_LT(word, layout.node_count);
      }
}

TEST(Clusters, DegenerateTrianglesAndFlattenedInstancesAreClustered) {
  Mesh mesh = testing::grid(30, 1);
  for (std::uint32_t v = 0; v < 100; ++v) mesh.triangles.push_back({v, v, v + 1});
  for (const auto& transform :
       {testing::scaling(1, 1, 1), testing::scaling(1, 0, 1), testing::scaling(0, 0, 0)}) {
    const GateLayout layout = layout_of({{testing::view(mesh)}, {{0, transform, Sides::front}}}, 0.5f);
    EXPECT_EQ(layout.report.clustered_surfaces, 1u);
    EXPECT_LT(layout.node_count, 2 * mesh.positions.size());
  }
}

}  // namespace
}  // namespace gatelight::neural
