#include "neural/layout/build_gate_layout.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>

#include "base/errors.h"
#include "neural/layout/mesh_colors.h"
#include "tests/neural/layout/meshes.h"
#include "tests/support/messages.h"

namespace gatelight::neural {
namespace {

using gatelight::tests::expect_refusal;
using gatelight::tests::expect_refused_parts;
using testing::Mesh;

/// Meshes of several sizes and kinds, instances of which some share a mesh and some have no storage.
struct Scene {
  std::vector<Mesh> meshes = {testing::sphere(96, 1), testing::grid(40, 2), testing::three_winged(),
                              testing::tetrahedron()};
  SurfaceLayout surfaces;
  explicit Scene(float scale = 1) {
    for (Mesh& mesh : meshes) {
      for (Float3& p : mesh.positions)
        for (float& x : p) x *= scale;
      surfaces.meshes.push_back(testing::view(mesh));
    }
    const auto at = [&](float x) { return testing::translation(scale * x, 0, 0); };
    surfaces.instances = {{0, at(0), Sides::front},
                          {1, at(3), Sides::both},
                          {2, testing::scaling(1, -2, 1), Sides::back},
                          {0, testing::scaling(3, 3, 3), Sides::both},
                          {3, at(1), Sides::none},
                          {1, testing::scaling(1, 0.1f, 0), Sides::back},
                          {0, at(8), Sides::front}};
  }
};

using Stack = std::vector<std::uint32_t>;

std::vector<GateOptions> many_options() {
  std::vector<GateOptions> all;
  for (const float spacing : {0.01f, 0.1f, 0.4f})
    for (const bool cluster : {false, true})
      for (const std::uint64_t budget : {0, 100000})
        for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper}) {
          if (budget != 0 && (!cluster || rule == ResolutionRule::paper)) continue;
          const GateOptions options{
              .rule = rule, .node_spacing = spacing, .cluster = cluster, .memory_budget = budget};
          all.push_back(options);
        }
  all.push_back(testing::fixed_options(3));
  all.push_back(testing::fixed_options(5, NodeStorage::per_triangle));
  all.back().stack = {kAdaptive, 1, 2, 8};
  const GateOptions parts{.stack = {kAdaptive, adaptive_part(4), 1}, .node_spacing = 0.02f};
  all.push_back(parts);
  // Levels with separate cells; with little memory all instances share clusters.
  GateOptions cells{.features = 1, .node_spacing = 0.1f};
  for (const Stack& stack :
       {Stack{kAdaptive, adaptive_part(4), adaptive_part(16)}, Stack{kAdaptive, 1, adaptive_part(3)}})
    for (const std::uint64_t budget : {0, 20000, 700}) {
      cells.stack = stack;
      cells.memory_budget = budget;
      all.push_back(cells);
    }
  cells.stack = {1, adaptive_part(8), kAdaptive, 2};
  for (const std::uint64_t budget : {0, 368000}) {
    cells.memory_budget = budget;
    all.push_back(cells);
  }
  return all;
}

TEST(GateLayout, APartOfTheAdaptiveResolutionIsRoundedAndAtLeastOne) {
  const Scene scene;
  GateOptions options;
  for (const float spacing : {0.01f, 0.03f, 0.1f, 1.0f}) {
    options.node_spacing = spacing;
    options.stack = {kAdaptive, adaptive_part(4), adaptive_part(3), adaptive_part(1)};
    const GateLayout layout = build_gate_layout(scene.surfaces, options);
    for (std::size_t s = 0; s < layout.surfaces.size(); ++s) {
      const GateSurfaceLevel* const levels = &layout.levels[s * layout.stack];
      const double whole = levels[0].resolution;
      if (whole == 0.0) continue;
      EXPECT_EQ(levels[1].resolution, std::max(1.0, std::round(whole / 4.0)));
      EXPECT_EQ(levels[2].resolution, std::max(1.0, std::round(whole / 3.0)));
      EXPECT_EQ(levels[3].resolution, whole);
    }
  }
}

TEST(GateLayout, EqualForAnyNumberOfThreads) {
  const auto expect_equal = [](const SurfaceLayout& surfaces, const GateOptions& options) {
    const GateLayout once = build_gate_layout(surfaces, options);
    for (const std::size_t threads : {1, 2, 7}) {
      const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
      testing::expect_same_tables(once, build_gate_layout(surfaces, options));
    }
  };
  const Scene scene;
  for (const GateOptions& options : many_options()) expect_equal(scene.surfaces, options);
  const Mesh many_chunks = testing::grid(160, 16);
  GateOptions options;
  for (const float spacing : {0.03f, 0.3f}) {
    options.node_spacing = spacing;
    expect_equal(testing::one_instance(many_chunks), options);
  }
}

TEST(GateLayout, EqualForASceneAndSpacingScaledByAPowerOfTwo) {
  const Scene scene;
  for (const float scale : {0x1p-20f, 0x1p20f}) {
    const Scene scaled(scale);
    for (GateOptions options : many_options()) {
      const GateLayout layout = build_gate_layout(scene.surfaces, options);
      options.node_spacing *= scale;
      const GateLayout other = build_gate_layout(scaled.surfaces, options);
      testing::expect_same_tables(layout, other);
      if (options.rule == ResolutionRule::uniform) {
        EXPECT_EQ(layout.report.node_spacing * scale, other.report.node_spacing);
      }
    }
  }
}

TEST(GateLayout, ASpacingScaleIsTheSpacingOfItsInstance) {
  for (GateOptions options : many_options()) {
    if (options.rule != ResolutionRule::uniform) continue;
    for (const float scale : {0.3f, 2.0f, 8.0f}) {
      // One instance and a given spacing: any scale works.
      const Scene all;
      if (options.memory_budget == 0) {
        for (const SurfaceInstance& instance : all.surfaces.instances) {
          SurfaceLayout one = {all.surfaces.meshes, {instance}};
          one.instances[0].spacing_scale = scale;
          const GateLayout scaled = build_gate_layout(one, options);
          one.instances[0].spacing_scale = 1;
          GateOptions wide = options;
          wide.node_spacing = scale * options.node_spacing;
          testing::expect_same_tables(scaled, build_gate_layout(one, wide));
        }
      }
      // All instances and perhaps a memory budget: for powers of two the search takes the same steps.
      if (scale < 1) continue;
      Scene equal;
      for (SurfaceInstance& instance : equal.surfaces.instances) instance.spacing_scale = scale;
      const GateLayout scaled = build_gate_layout(equal.surfaces, options);
      GateOptions wide = options;
      wide.node_spacing = scale * options.node_spacing;
      const GateLayout wider = build_gate_layout(all.surfaces, wide);
      testing::expect_same_tables(scaled, wider);
      EXPECT_EQ(scale * scaled.report.node_spacing, wider.report.node_spacing);
    }
  }
}

TEST(GateLayout, SpacingScalesOfOtherInstancesChangeNothing) {
  Scene scene;
  GateOptions options{.stack = {kAdaptive, adaptive_part(4), 1}, .node_spacing = 0.2f};
  const GateLayout before = build_gate_layout(scene.surfaces, options);
  scene.surfaces.instances[3].spacing_scale = 0.25f;
  const GateLayout after = build_gate_layout(scene.surfaces, options);
  for (std::uint32_t s = 0; s < before.surfaces.size(); ++s)
    for (std::uint32_t l = 0; l < 3; ++l) {
      const std::uint32_t a = before.levels[3 * s + l].resolution;
      const std::uint32_t b = after.levels[3 * s + l].resolution;
      if (s / 2 == 3 && l < 2) {
        EXPECT_EQ(b > a, l == 0) << s << l;
      } else {
        EXPECT_EQ(a, b);
      }
    }
  EXPECT_GT(after.node_count, before.node_count);
}

TEST(GateLayout, EveryNodeIsReachedAndCountedOnce) {
  const Scene scene;
  for (const GateOptions& options : many_options()) {
    const GateLayout layout = build_gate_layout(scene.surfaces, options);
    testing::expect_all_nodes_reached(layout);
    const GateLayoutReport& report = layout.report;
    EXPECT_EQ(report.vertex_nodes + report.edge_nodes + report.interior_nodes + report.cluster_nodes +
                  report.triangle_nodes,
              layout.node_count);
    EXPECT_EQ(report.topology_bytes, 4 * layout.topology.size());
    EXPECT_EQ(report.table_bytes, 16 * layout.surfaces.size() + 20 * layout.levels.size());
    EXPECT_EQ(std::accumulate(report.resolution_histogram.begin(), report.resolution_histogram.end(), 0u),
              6u);
  }
}

TEST(GateLayout, ASideWithoutStorageUsesTheNodesOfTheOther) {
  const Mesh mesh = testing::tetrahedron();
  const auto layout_of = [&](Sides sides) {
    return build_gate_layout(testing::one_instance(mesh, sides), testing::fixed_options(4));
  };
  const GateLayout front = layout_of(Sides::front);
  const GateLayout back = layout_of(Sides::back);
  const GateLayout both = layout_of(Sides::both);
  testing::expect_same_tables(front, back);
  EXPECT_EQ(both.node_count, 2 * front.node_count);
  EXPECT_EQ(both.triangle_count, 8u);
  EXPECT_EQ(front.triangle_count, 4u);
  EXPECT_EQ(both.surfaces[0].first_triangle, 0u);
  EXPECT_EQ(both.surfaces[1].first_triangle, 4u);
  EXPECT_EQ(front.surfaces[1].first_triangle, 0u);
  for (std::uint32_t n = 0; n < 100; ++n) {
    const auto b = testing::random_barycentrics(1, n);
    const auto nodes = [&](const GateLayout& layout, std::uint32_t side) {
      return gate_lookup(layout, side, 0, n % 4, b)->nodes;
    };
    EXPECT_EQ(nodes(front, 0), nodes(front, 1));
    EXPECT_EQ(nodes(both, 0), nodes(front, 0));
    auto shifted = nodes(both, 0);
    for (std::uint32_t& node : shifted) node += front.node_count;
    EXPECT_EQ(nodes(both, 1), shifted);
  }
  EXPECT_EQ(both.topology, front.topology);
}

TEST(GateLayout, InstancesAndMeshesWithoutStorageCostNothing) {
  const Mesh small = testing::tetrahedron();
  const Mesh large = testing::grid(30, 1);
  for (const NodeStorage storage : {NodeStorage::shared, NodeStorage::per_triangle}) {
    const GateOptions options = testing::fixed_options(3, storage);
    const GateLayout alone = build_gate_layout(testing::one_instance(small), options);
    SurfaceLayout scene = {{testing::view(large), testing::view(small), testing::view(large)},
                           {{0}, {1}, {0}}};
    scene.instances[0].sides = scene.instances[2].sides = Sides::none;
    const GateLayout layout = build_gate_layout(scene, options);
    EXPECT_EQ(layout.node_count, alone.node_count);
    EXPECT_EQ(layout.triangle_count, alone.triangle_count);
    EXPECT_TRUE(layout.topology == alone.topology);
    for (const std::uint32_t surface : {0u, 1u, 4u, 5u}) {
      EXPECT_EQ(layout.levels[surface].resolution, 0u);
      EXPECT_FALSE(gate_lookup(layout, surface, 0, 0, std::array{1.0, 0.0, 0.0}).has_value());
    }
    EXPECT_TRUE(gate_lookup(layout, 2, 0, 0, std::array{1.0, 0.0, 0.0}).has_value());
    EXPECT_FALSE(gate_lookup(layout, 2, 0, 4, std::array{1.0, 0.0, 0.0}).has_value());
    EXPECT_FALSE(gate_lookup(layout, 6, 0, 0, std::array{1.0, 0.0, 0.0}).has_value());
  }
}

TEST(GateLayout, PositionsThatNoTriangleUsesCostNothing) {
  const Mesh mesh = testing::grid(5, 1);
  Mesh spread = {{}, mesh.triangles};
  for (const Float3& p : mesh.positions)
    spread.positions.insert(spread.positions.end(), {{9, 9, 9}, p, {7, 7, 7}});
  for (auto& triangle : spread.triangles)
    for (std::uint32_t& v : triangle) v = 3 * v + 1;
  for (const std::uint32_t r : {1u, 4u})
    testing::expect_same_tables(build_gate_layout(testing::one_instance(mesh), testing::fixed_options(r)),
                                build_gate_layout(testing::one_instance(spread), testing::fixed_options(r)));
}

TEST(GateLayout, InstancesOfAMeshShareItsTopologyAndNotItsNodes) {
  const Mesh mesh = testing::grid(10, 1);
  SurfaceLayout scene = testing::one_instance(mesh, Sides::both);
  scene.instances.resize(5, scene.instances[0]);
  const GateLayout layout = build_gate_layout(scene, testing::fixed_options(2));
  const GateLayout alone = build_gate_layout(testing::one_instance(mesh), testing::fixed_options(2));
  EXPECT_TRUE(layout.topology == alone.topology);
  EXPECT_EQ(layout.node_count, 10 * alone.node_count);
  std::set<std::uint32_t> bases;
  for (const GateSurfaceLevel& level : layout.levels) bases.insert(level.vertex_base);
  EXPECT_EQ(bases.size(), 10u);
}

TEST(GateLayout, AnEmptySceneHasAnEmptyLayout) {
  GateOptions options;
  for (const std::uint64_t budget : {0, 1000}) {
    options.memory_budget = budget;
    for (const ResolutionRule rule :
         {ResolutionRule::uniform, ResolutionRule::paper, ResolutionRule::fixed}) {
      options.rule = rule;
      EXPECT_EQ(build_gate_layout({}, options).node_count, 0u);
      const Mesh empty;
      EXPECT_EQ(build_gate_layout(testing::one_instance(empty), options).node_count, 0u);
    }
  }
}

TEST(GateLayout, OptionsOutOfRangeAreRefusedByName) {
  const Mesh mesh = testing::tetrahedron();
  const auto expect_refused = [&](const char* name, const char* value,
                                  const std::function<void(GateOptions&)>& change) {
    GateOptions options;
    change(options);
    expect_refused_parts<BadConfiguration>([&] { build_gate_layout(testing::one_instance(mesh), options); },
                                           {name, value});
  };
  expect_refused("features", "0", [](GateOptions& o) { o.features = 0; });
  expect_refused("features", "17", [](GateOptions& o) { o.features = 17; });
  expect_refused("stack", "0", [](GateOptions& o) { o.stack.clear(); });
  expect_refused("stack", "5", [](GateOptions& o) { o.stack.assign(5, 1); });
  expect_refused("stack", "65", [](GateOptions& o) { o.stack = {1, 65}; });
  expect_refused("stack", "adaptive/65", [](GateOptions& o) { o.stack = {adaptive_part(65)}; });
  expect_refused("node-spacing", "0", [](GateOptions& o) { o.node_spacing = 0; });
  expect_refused("node-spacing", "nan", [](GateOptions& o) { o.node_spacing = std::nanf(""); });
  expect_refused("resolution-scale", "-1", [](GateOptions& o) { o.resolution_scale = -1; });
  expect_refused("resolution", "65", [](GateOptions& o) { o.fixed_resolution = 65; });
  expect_refused("max-resolution", "0", [](GateOptions& o) { o.max_resolution = 0; });
  expect_refused("bytes-per-feature", "3", [](GateOptions& o) { o.bytes_per_feature = 3; });
}

TEST(GateLayout, InvalidSurfacesAreRefusedByName) {
  Mesh mesh = testing::tetrahedron();
  const auto expect_refused = [&](const SurfaceLayout& scene, const gatelight::tests::NameList& names) {
    expect_refusal<BadConfiguration>([&] { build_gate_layout(scene, {}); }, names);
  };
  expect_refused({{testing::view(mesh)}, {{0}, {2}}}, {"instance 1", "mesh 2"});
  mesh.triangles[2][1] = 4;
  expect_refused(testing::one_instance(mesh), {"mesh 0", "triangle 2", "index 4"});
  mesh = testing::tetrahedron();
  mesh.positions[3][1] = std::numeric_limits<float>::infinity();
  expect_refused(testing::one_instance(mesh), {"mesh 0", "position 3", "(0, inf, 1)"});
  mesh = testing::tetrahedron();
  SurfaceLayout scene = testing::one_instance(mesh);
  scene.instances[0].object_to_world[5] = std::nanf("");
  expect_refused(scene, {"instance 0", "nan"});
  for (const char* scale : {"0", "-1", "nan", "inf"}) {
    scene = testing::one_instance(mesh);
    scene.instances[0].spacing_scale = std::stof(scale);
    expect_refused(scene, {"instance 0", scale});
  }
}

}  // namespace
}  // namespace gatelight::neural
