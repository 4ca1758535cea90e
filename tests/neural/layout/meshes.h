#pragma once
// Small meshes, and the layouts of scenes of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "base/random.h"
#include "neural/layout/mesh_colors.h"

namespace gatelight::neural::testing {

struct Mesh {
  std::vector<Float3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

inline Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// Three triangles that share the edge from 0 to 1.
inline Mesh three_winged() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0, -1, -1}}, {{0, 1, 2}, {1, 0, 3}, {4, 0, 1}}};
}

/// n x n squares of two triangles each, over [0,size]^2 in x and y.
inline Mesh grid(std::uint32_t n, float size) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x)
      mesh.positions.push_back({size * static_cast<float>(x) / static_cast<float>(n),
                                size * static_cast<float>(y) / static_cast<float>(n), 0});
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x;
      mesh.triangles.push_back({a, a + 1, a + n + 2});
      mesh.triangles.push_back({a, a + n + 2, a + n + 1});
    }
  return mesh;
}

/// A closed sphere around the origin: a ring of n quads times n/2, poles included, 2 n (n/2 - 1) triangles.
inline Mesh sphere(std::uint32_t n, float radius) {
  Mesh mesh;
  const double pi = std::acos(-1.0);
  const std::uint32_t rings = n / 2;
  const auto add = [&](double theta, double phi) {
    mesh.positions.push_back({static_cast<float>(radius * std::sin(theta) * std::cos(phi)),
                              static_cast<float>(radius * std::sin(theta) * std::sin(phi)),
                              static_cast<float>(radius * std::cos(theta))});
  };
  add(0, 0);
  for (std::uint32_t y = 1; y < rings; ++y)
    for (std::uint32_t x = 0; x < n; ++x) add(pi * y / rings, 2 * pi * x / n);
  add(pi, 0);
  const auto south = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t x = 0; x < n; ++x) {
    const std::uint32_t next = (x + 1) % n;
    mesh.triangles.push_back({0, 1 + x, 1 + next});
    for (std::uint32_t y = 0; y + 2 < rings; ++y) {
      const std::uint32_t a = 1 + y * n;
      mesh.triangles.push_back({a + x, a + n + x, a + n + next});
      mesh.triangles.push_back({a + x, a + n + next, a + next});
    }
    const std::uint32_t last = 1 + (rings - 2) * n;
    mesh.triangles.push_back({last + x, south, last + next});
  }
  return mesh;
}

inline std::uint64_t count_edges(const Mesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles)
    for (int c = 0; c < 3; ++c) edges.insert(std::minmax(t[c], t[(c + 1) % 3]));
  return edges.size();
}

inline SurfaceMesh view(const Mesh& mesh) {
  return {mesh.positions, mesh.triangles};
}

/// The layout refers to `mesh`, which must outlive it.
inline SurfaceLayout one_instance(const Mesh& mesh, Sides sides = Sides::front) {
  return {{view(mesh)}, {{.mesh = 0, .sides = sides}}};
}

inline std::array<float, 12> translation(float x, float y, float z) {
  return {1, 0, 0, 0, 1, 0, 0, 0, 1, x, y, z};
}

inline std::array<float, 12> scaling(float x, float y, float z) {
  return {x, 0, 0, 0, y, 0, 0, 0, z, 0, 0, 0};
}

inline GateOptions fixed_options(std::uint32_t resolution, NodeStorage storage = NodeStorage::shared) {
  GateOptions options{.features = 1,
                      .stack = {kAdaptive},
                      .rule = ResolutionRule::fixed,
                      .fixed_resolution = resolution,
                      .storage = storage};
  return options;
}

inline std::uint64_t feature_bytes(const GateLayout& layout, const GateOptions& options) {
  return std::uint64_t{layout.node_count} * options.features * options.bytes_per_feature;
}

/// Compares everything except the report.
inline void expect_same_tables(const GateLayout& a, const GateLayout& b) {
  EXPECT_EQ(a.features, b.features);
  EXPECT_EQ(a.stack, b.stack);
  EXPECT_EQ(a.storage, b.storage);
  EXPECT_EQ(a.node_count, b.node_count);
  EXPECT_EQ(a.triangle_count, b.triangle_count);
  EXPECT_TRUE(a.topology == b.topology);
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  const auto surface = [](const GateSurface& s) {
    return std::array{s.topology_offset, s.topology_stride, s.triangle_count, s.first_triangle};
  };
  for (std::size_t s = 0; s < a.surfaces.size(); ++s)
    EXPECT_EQ(surface(a.surfaces[s]), surface(b.surfaces[s]));
  ASSERT_EQ(a.levels.size(), b.levels.size());
  const auto level = [](const GateSurfaceLevel& l) {
    return std::array{l.resolution, l.vertex_base, l.edge_base, l.interior_base, l.corners};
  };
  for (std::size_t l = 0; l < a.levels.size(); ++l) EXPECT_EQ(level(a.levels[l]), level(b.levels[l]));
}

/// Expects that the triangles reach every node of the layout.
inline void expect_all_nodes_reached(const GateLayout& layout) {
  std::vector<char> reached(layout.node_count, 0);
  for (std::uint32_t s = 0; s < layout.surfaces.size(); ++s)
    for (std::uint32_t l = 0; l < layout.stack; ++l) {
      const std::uint32_t r = layout.levels[s * layout.stack + l].resolution;
      if (r == 0) continue;
      for (std::uint32_t t = 0; t < layout.surfaces[s].triangle_count; ++t)
        for (std::uint32_t i = 0; i <= r; ++i)
          for (std::uint32_t j = 0; i + j <= r; ++j) {
            const std::uint32_t node = node_index(layout, s, l, t, {i, j, r - i - j});
            ASSERT_LT(node, layout.node_count);
            reached[node] = 1;
          }
    }
  EXPECT_EQ(std::ranges::count(reached, 1), layout.node_count);
}

/// Uniform in [0,1), in double precision.
inline double uniform(std::uint64_t key, std::uint64_t counter) {
  return static_cast<double>(mix_bits(mix_bits(key) ^ counter) >> 11) * 0x1p-53;
}

/// A point on the triangle, uniformly.
inline std::array<double, 3> random_barycentrics(std::uint64_t key, std::uint64_t counter) {
  double u = uniform(key, 2 * counter);
  double v = uniform(key, 2 * counter + 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return {1 - u - v, u, v};
}

}  // namespace gatelight::neural::testing
