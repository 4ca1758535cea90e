#pragma once
// Mesh colours (Yuksel, Keyser, House 2010): the three nodes around a point on a triangle, their weights, and
// the index of a node in the layout. These are pure functions, for float and double.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "neural/layout/gate_layout.h"

namespace gatelight::neural {

/// The node at the barycentrics (i,j,k)/R; i, j, k >= 0 have the sum R.
using NodeBarycentrics = std::array<std::uint32_t, 3>;

constexpr std::uint32_t nodes_per_edge(std::uint32_t resolution) {
  return resolution == 0 ? 0 : resolution - 1;
}
constexpr std::uint32_t nodes_per_interior(std::uint32_t resolution) {
  return resolution < 3 ? 0 : (resolution - 1) * (resolution - 2) / 2;
}
constexpr std::uint32_t nodes_per_triangle(std::uint32_t resolution) {
  return resolution == 0 ? 0 : (resolution + 1) * (resolution + 2) / 2;
}

/// Maps weights to a point on the triangle: negative weights and NaN become zero, and the sum becomes one.
/// Without a positive weight the result is the first corner.
template <typename T>
std::array<T, 3> sanitize_barycentrics(std::array<T, 3> b) {
  using Limits = std::numeric_limits<T>;
  for (T& weight : b) weight = weight > T(0) ? std::fmin(weight, Limits::max() / 4) : T(0);
  T sum = b[0] + b[1] + b[2];
  if (sum < Limits::min()) {  // denormal, which the division may flush to zero
    for (T& weight : b) weight *= T(0x1p60);
    sum = b[0] + b[1] + b[2];
    if (!(sum > T(0))) return {T(1), T(0), T(0)};
  }
  return {b[0] / sum, b[1] / sum, b[2] / sum};
}

/// The small triangle of nodes around a point; weights are >= 0 and have the sum one. A point on a node has
/// that node three times, with the weights (1, 0, 0).
template <typename T>
struct MeshColorSample {
  std::array<NodeBarycentrics, 3> nodes;
  std::array<T, 3> weights;
};

/// Splits R b into floors and fractions w. The sum of the fractions is an integer up to rounding; it is
/// computed exactly as R minus the sum of the floors. 1 means a small triangle with the big one's
/// orientation, 2 an inverted one; 0 and 3 (all fractions just below one) mean a node.
template <typename T>
MeshColorSample<T> mesh_color_lookup(const std::array<T, 3>& barycentrics, std::uint32_t resolution) {
  const std::array<T, 3> b = sanitize_barycentrics(barycentrics);
  NodeBarycentrics low;
  std::array<T, 3> w;
  for (int c = 0; c < 3; ++c) {
    const T scaled = b[c] * static_cast<T>(resolution);
    const T whole = std::floor(scaled);
    low[c] = static_cast<std::uint32_t>(whole);
    w[c] = scaled - whole;
  }
  const auto [i, j, k] = low;
  switch (resolution - (i + j + k)) {
    case 1: {
      const T sum = w[0] + w[1] + w[2];
      return {{{{i + 1, j, k}, {i, j + 1, k}, {i, j, k + 1}}}, {w[0] / sum, w[1] / sum, w[2] / sum}};
    }
    case 2: {
      const T sum = (T(1) - w[0]) + (T(1) - w[1]) + (T(1) - w[2]);
      return {{{{i, j + 1, k + 1}, {i + 1, j, k + 1}, {i + 1, j + 1, k}}},
              {(T(1) - w[0]) / sum, (T(1) - w[1]) / sum, (T(1) - w[2]) / sum}};
    }
    case 3:
      low = {i + 1, j + 1, k + 1};
      break;
    default:
      break;
  }
  return {{low, low, low}, {T(1), T(0), T(0)}};
}

/// Index of a triangle's node among all nodes, by the formulas of GateSurfaceLevel. The level must have
/// storage.
inline std::uint32_t node_index(const GateLayout& layout, std::uint32_t surface, std::uint32_t level,
                                std::uint32_t triangle, const NodeBarycentrics& node) {
  const GateSurface& s = layout.surfaces[surface];
  const GateSurfaceLevel& l = layout.levels[std::size_t{surface} * layout.stack + level];
  const std::uint32_t r = l.resolution;
  const auto [i, j, k] = node;
  if (layout.storage == NodeStorage::per_triangle)
    return l.vertex_base + triangle * nodes_per_triangle(r) + i * (2 * r + 3 - i) / 2 + j;
  if (i > 0 && j > 0 && k > 0)
    return l.interior_base + triangle * nodes_per_interior(r) + (i - 1) * (2 * (r - 1) - i) / 2 + j - 1;
  const std::uint32_t* row =
      layout.topology.data() + s.topology_offset + std::size_t{triangle} * s.topology_stride;
  const std::uint32_t* corners = row + l.corners;
  for (std::uint32_t c = 0; c < 3; ++c)
    if (node[c] == r) return l.vertex_base + corners[c];
  const std::uint32_t c = i == 0 ? 0 : j == 0 ? 1 : 2;  // the corner opposite to the edge
  const std::uint32_t first = (c + 1) % 3;
  const std::uint32_t second = (c + 2) % 3;
  const std::uint32_t steps = corners[first] < corners[second] ? node[second] : node[first];
  return l.edge_base + row[kTopologyEdges + c] * nodes_per_edge(r) + steps - 1;
}

template <typename T>
struct GateSample {
  std::array<std::uint32_t, 3> nodes;
  std::array<T, 3> weights;
};

/// The nodes and weights of one level at a point given by barycentrics. Returns nullopt for a surface without
/// storage and for a surface or triangle out of range.
template <typename T>
std::optional<GateSample<T>> gate_lookup(const GateLayout& layout, std::uint32_t surface, std::uint32_t level,
                                         std::uint32_t triangle, const std::array<T, 3>& barycentrics) {
  if (surface >= layout.surfaces.size() || triangle >= layout.surfaces[surface].triangle_count) return {};
  const std::uint32_t resolution = layout.levels[std::size_t{surface} * layout.stack + level].resolution;
  if (resolution == 0) return {};
  const MeshColorSample<T> sample = mesh_color_lookup(barycentrics, resolution);
  GateSample<T> result{{}, sample.weights};
  for (int t = 0; t < 3; ++t) result.nodes[t] = node_index(layout, surface, level, triangle, sample.nodes[t]);
  return result;
}

}  // namespace gatelight::neural
