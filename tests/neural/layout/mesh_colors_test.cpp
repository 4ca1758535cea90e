#include "neural/layout/mesh_colors.h"
#include "neural/layout/build_gate_layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "tests/neural/layout/meshes.h"

namespace gatelight::neural {
namespace {

using testing::Mesh;
using testing::uniform;

template <typename T>
std::array<T, 3> to(const std::array<double, 3>& b) {
  return {static_cast<T>(b[0]), static_cast<T>(b[1]), static_cast<T>(b[2])};
}

template <typename T>
void expect_valid(const MeshColorSample<T>& sample, std::uint32_t resolution) {
  T sum = 0;
  for (int t = 0; t < 3; ++t) {
    const auto [i, j, k] = sample.nodes[t];
    ASSERT_LE(i, resolution);
    ASSERT_LE(j, resolution);
    ASSERT_EQ(i + j + k, resolution);
    ASSERT_GE(sample.weights[t], T(0));
    sum += sample.weights[t];
  }
  ASSERT_NEAR(sum, T(1), 4 * std::numeric_limits<T>::epsilon());
}

/// Returns the weighted sum of the nodes' own barycentrics, which is the point itself.
template <typename T>
std::array<double, 3> interpolated_place(const MeshColorSample<T>& sample, std::uint32_t resolution) {
  std::array<double, 3> place = {0, 0, 0};
  for (int t = 0; t < 3; ++t)
    for (int c = 0; c < 3; ++c)
      place[c] += static_cast<double>(sample.weights[t]) * sample.nodes[t][c] / resolution;
  return place;
}

std::vector<NodeBarycentrics> all_nodes(std::uint32_t resolution) {
  std::vector<NodeBarycentrics> nodes;
  for (std::uint32_t i = 0; i <= resolution; ++i)
    for (std::uint32_t j = 0; i + j <= resolution; ++j) nodes.push_back({i, j, resolution - i - j});
  return nodes;
}

template <typename T>
class MeshColors : public ::testing::Test {};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MeshColors, Precisions);

TYPED_TEST(MeshColors, WeightsAreAPartitionOfUnityAndReproduceAffineFields) {
  const double tolerance = 8 * std::numeric_limits<TypeParam>::epsilon();
  for (std::uint32_t r = 1; r <= kMaxResolution; ++r)
    for (std::uint32_t n = 0; n < 1000; ++n) {
      const auto b = to<TypeParam>(testing::random_barycentrics(r, n));
      const auto sample = mesh_color_lookup(b, r);
      expect_valid(sample, r);
      const auto place = interpolated_place(sample, r);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(place[c], b[c], tolerance);
    }
}

TYPED_TEST(MeshColors, EveryNodeHasTheWholeWeightAtItsPosition) {
  for (std::uint32_t r = 1; r <= kMaxResolution; ++r)
    for (const NodeBarycentrics& node : all_nodes(r)) {
      std::array<TypeParam, 3> b;
      for (int c = 0; c < 3; ++c) b[c] = static_cast<TypeParam>(node[c]) / static_cast<TypeParam>(r);
      const auto sample = mesh_color_lookup(b, r);
      expect_valid(sample, r);
      TypeParam weight = 0;
      for (int t = 0; t < 3; ++t)
        if (sample.nodes[t] == node) weight += sample.weights[t];
      ASSERT_NEAR(weight, TypeParam(1), 128 * std::numeric_limits<TypeParam>::epsilon());
    }
}

TYPED_TEST(MeshColors, RoundingAroundNodesAndEdgesNeverLeavesTheTriangle) {
  using Limits = std::numeric_limits<TypeParam>;
  const auto nudge = [](TypeParam x, int direction) {
    return direction == 0 ? x : std::nextafter(x, direction > 0 ? TypeParam(2) : TypeParam(-2));
  };
  for (std::uint32_t r = 1; r <= kMaxResolution; ++r)
    for (const NodeBarycentrics& node : all_nodes(r))
      for (int directions = 0; directions < 27; ++directions) {
        std::array<TypeParam, 3> b;
        for (int c = 0, d = directions; c < 3; ++c, d /= 3)
          b[c] = nudge(static_cast<TypeParam>(node[c]) / static_cast<TypeParam>(r), d % 3 - 1);
        const auto sample = mesh_color_lookup(b, r);
        expect_valid(sample, r);
        const auto place = interpolated_place(sample, r);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(place[c], b[c], 16 * Limits::epsilon());
      }
}

TYPED_TEST(MeshColors, BarycentricsOutsideAreClampedAndTheRestIsNormalised) {
  using Limits = std::numeric_limits<TypeParam>;
  const auto check = [](std::array<TypeParam, 3> given, std::array<TypeParam, 3> expected) {
    const auto b = sanitize_barycentrics(given);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(b[c], expected[c], 2 * Limits::epsilon());
    for (std::uint32_t r = 1; r <= kMaxResolution; ++r) expect_valid(mesh_color_lookup(given, r), r);
  };
  const TypeParam tiny = Limits::denorm_min();
  const TypeParam big = Limits::max();
  check({1, 0, 0}, {1, 0, 0});
  check({0, 0, 1}, {0, 0, 1});
  check({TypeParam(0.5), TypeParam(0.5), 0}, {TypeParam(0.5), TypeParam(0.5), 0});
  check({TypeParam(1.000001), TypeParam(-0.000001), 0}, {1, 0, 0});
  check({TypeParam(-0.25), TypeParam(0.75), TypeParam(0.5)}, {0, TypeParam(0.6), TypeParam(0.4)});
  check({3, 1, 0}, {TypeParam(0.75), TypeParam(0.25), 0});
  check({0, 0, 0}, {1, 0, 0});
  check({-1, -2, -3}, {1, 0, 0});
  check({Limits::quiet_NaN(), 0, 1}, {0, 0, 1});
  check({Limits::quiet_NaN(), Limits::quiet_NaN(), Limits::quiet_NaN()}, {1, 0, 0});
  check({Limits::infinity(), 0, 0}, {1, 0, 0});
  check({big, big, big}, {TypeParam(1) / 3, TypeParam(1) / 3, TypeParam(1) / 3});
  check({tiny, 0, 0}, {1, 0, 0});
  check({0, tiny, tiny}, {0, TypeParam(0.5), TypeParam(0.5)});
  check({tiny, 0, 1}, {0, 0, 1});
  check({3 * tiny, tiny, 0}, {TypeParam(0.75), TypeParam(0.25), 0});
}

/// A field with a random value at each node.
double node_value(std::uint32_t node) {
  return 2 * uniform(7, node) - 1;
}

double field(const GateLayout& layout, std::uint32_t triangle, const std::array<double, 3>& b) {
  const auto sample = gate_lookup(layout, 0, 0, triangle, b);
  double value = 0;
  for (int t = 0; t < 3; ++t) value += sample->weights[t] * node_value(sample->nodes[t]);
  return value;
}

class MeshColorField : public ::testing::TestWithParam<NodeStorage> {};
INSTANTIATE_TEST_SUITE_P(Storages, MeshColorField,
                         ::testing::Values(NodeStorage::shared, NodeStorage::per_triangle));

TEST_P(MeshColorField, ContinuousAcrossVirtualEdgesAndNodes) {
  const Mesh mesh = testing::tetrahedron();
  for (std::uint32_t r = 1; r <= kMaxResolution; ++r) {
    const GateLayout layout =
        build_gate_layout(testing::one_instance(mesh), testing::fixed_options(r, GetParam()));
    const double step = 1e-9;
    // Neighbours' values differ by less than 2 over a distance of 1/R in each barycentric.
    const double most = 4.0 * r * step;
    const auto expect_continuous = [&](const std::array<double, 3>& at, std::uint64_t n) {
      const double angle = 6.283185307179586 * uniform(r, n);
      const double du = step * std::cos(angle);
      const double dv = step * std::sin(angle);
      ASSERT_NEAR(field(layout, 1, at), field(layout, 1, {at[0] - du - dv, at[1] + du, at[2] + dv}), most);
    };
    for (const NodeBarycentrics& node : all_nodes(r))
      expect_continuous({1.0 * node[0] / r, 1.0 * node[1] / r, 1.0 * node[2] / r}, node[0] * 64 + node[1]);
    for (std::uint64_t n = 0; n < 300; ++n) {
      // A point on a line where one of R b is an integer.
      const auto line = static_cast<double>(mix_bits(n) % (r + 1)) / r;
      const double along = (1 - line) * uniform(11, n);
      std::array<double, 3> at = {line, along, 1 - line - along};
      std::rotate(at.begin(), at.begin() + n % 3, at.end());
      expect_continuous(at, n);
    }
  }
}

TEST_P(MeshColorField, EachPositionHasOneNodeAndEachNodeOnePosition) {
  const NodeStorage storage = GetParam();
  for (const Mesh& mesh : {testing::tetrahedron(), testing::grid(2, 1), testing::three_winged()})
    for (std::uint32_t r = 1; r <= kMaxResolution; ++r) {
      const GateLayout layout =
          build_gate_layout(testing::one_instance(mesh), testing::fixed_options(r, storage));
      // Node indices by position: at a mesh vertex, on a mesh edge, or inside one triangle.
      std::map<std::array<std::uint32_t, 4>, std::set<std::uint32_t>> places;
      std::set<std::uint32_t> indices;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (const NodeBarycentrics& node : all_nodes(r)) {
          std::vector<std::array<std::uint32_t, 2>> on;  // mesh vertices with their barycentrics
          for (int c = 0; c < 3; ++c)
            if (node[c] > 0) on.push_back({mesh.triangles[t][c], node[c]});
          std::ranges::sort(on);
          std::array<std::uint32_t, 4> place = {t + 1, node[0], node[1], 0};
          if (on.size() == 1) place = {0, on[0][0], 0, 0};
          if (on.size() == 2) place = {0, on[0][0], on[1][0], on[1][1]};
          if (storage == NodeStorage::per_triangle) place = {t + 1, node[0], node[1], node[2]};
          const std::uint32_t index = node_index(layout, 0, 0, t, node);
          places[place].insert(index);
          indices.insert(index);
        }
      for (const auto& [place, nodes] : places) ASSERT_EQ(nodes.size(), 1u);
      ASSERT_EQ(indices.size(), places.size());
      ASSERT_EQ(indices.size(), layout.node_count);
      ASSERT_EQ(*indices.rbegin(), layout.node_count - 1);
    }
}

TEST(MeshColorCounts, SharedNodesAreVerticesAndEdgesAndInteriors) {
  for (const Mesh& mesh :
       {testing::tetrahedron(), testing::grid(3, 1), testing::three_winged(), testing::sphere(8, 1)})
    for (std::uint64_t r = 1; r <= kMaxResolution; ++r) {
      const auto options = testing::fixed_options(static_cast<std::uint32_t>(r));
      const GateLayout layout = build_gate_layout(testing::one_instance(mesh), options);
      const std::uint64_t interior = mesh.triangles.size() * (r - 1) * (r - 2) / 2;
      EXPECT_EQ(layout.node_count, mesh.positions.size() + testing::count_edges(mesh) * (r - 1) + interior);
      EXPECT_EQ(layout.report.vertex_nodes, mesh.positions.size());
      EXPECT_EQ(layout.report.edge_nodes, testing::count_edges(mesh) * (r - 1));
      EXPECT_EQ(layout.report.interior_nodes, interior);
    }
}

TEST(MeshColorEdges, TwoTrianglesAgreeAlongTheirEdgeInAllOrientations) {
  // Corners 0 and 1 are shared, 2 and 3 are not; each triangle in all six orders of its corners.
  for (std::uint32_t r = 1; r <= kMaxResolution; ++r) {
    std::array<std::uint32_t, 3> one = {0, 1, 2};
    do {
      std::array<std::uint32_t, 3> two = {0, 1, 3};
      do {
        const Mesh mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {one, two}};
        const GateLayout layout = build_gate_layout(testing::one_instance(mesh), testing::fixed_options(r));
        for (std::uint32_t n = 0; n <= 2 * r + 1; ++n) {
          // All nodes of the edge, and points between them.
          const double s = n < 2 * r + 1 ? 0.5 * n / r : uniform(3, r);
          const auto on_edge = [&](const std::array<std::uint32_t, 3>& corners) {
            std::array<double, 3> b = {0, 0, 0};
            for (int c = 0; c < 3; ++c) b[c] = corners[c] == 0 ? 1 - s : corners[c] == 1 ? s : 0;
            return b;
          };
          ASSERT_NEAR(field(layout, 0, on_edge(one)), field(layout, 1, on_edge(two)), 1e-12)
              << "R " << r << " at " << s;
        }
      } while (std::next_permutation(two.begin(), two.end()));
    } while (std::next_permutation(one.begin(), one.end()));
  }
}

}  // namespace
}  // namespace gatelight::neural
