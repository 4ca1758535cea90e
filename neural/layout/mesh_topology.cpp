#include "neural/layout/mesh_topology.h"

#include <tbb/parallel_sort.h>

#include <atomic>

#include "base/parallel/loops.h"
#include "neural/layout/prefix_sum.h"

namespace gatelight::neural {

namespace {

constexpr std::size_t kSmallMesh = 1 << 20;  // triangles; one thread is faster below

void add_corners(MeshTopology& topology) {
  if (!topology.corners)
    topology.corners =
        build_vertex_corners(topology.triangles, static_cast<std::uint32_t>(topology.vertices.size()));
}

/// A triangle's edge, listed at the lower of its two vertices.
struct HalfEdge {
  std::uint32_t high = 0;
  std::uint32_t slot = 0;  ///< 3 * triangle + opposite corner
  friend auto operator<=>(const HalfEdge&,
                          const HalfEdge&) = default;  // NOLINT(modernize-use-nullptr): no pointer
};

void list_edges(const MeshTopology& topology, std::uint32_t vertex, std::vector<HalfEdge>& edges) {
  edges.clear();
  const VertexCorners& around = *topology.corners;
  for (std::uint32_t a = around.offsets[vertex]; a < around.offsets[vertex + 1]; ++a) {
    const std::uint32_t corner = around.corners[a];
    const std::uint32_t first_slot = corner - corner % 3;
    const std::uint32_t next = (corner + 1 - first_slot) % 3;
    const std::uint32_t previous = (corner + 2 - first_slot) % 3;
    const TriangleCorners& triangle = topology.triangles[corner / 3];
    if (triangle[next] >= vertex) edges.push_back({triangle[next], first_slot + previous});
    // An edge from a vertex to itself is listed once, by the condition above.
    if (triangle[previous] > vertex) edges.push_back({triangle[previous], first_slot + next});
  }
  tbb::parallel_sort(edges.begin(), edges.end());
}

}  // namespace

MeshTopology number_vertices(const SurfaceMesh& mesh) {
  MeshTopology topology;
  std::vector<std::uint32_t> numbers(mesh.positions.size(), 0);
  const std::size_t triangles = mesh.triangles.size();
  for_each_range(triangles, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t != end; ++t)
      for (const std::uint32_t v : mesh.triangles[t])
        std::atomic_ref(numbers[v]).store(1, std::memory_order_relaxed);
  });
  inclusive_prefix_sum(numbers);  // for a used position: the vertex's number plus one
  topology.vertices.resize(numbers.empty() ? 0 : numbers.back());
  for_each_range(numbers.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p != end; ++p)
      if (numbers[p] != (p == 0 ? 0 : numbers[p - 1]))
        topology.vertices[numbers[p] - 1] = static_cast<std::uint32_t>(p);
  });
  topology.triangles.resize(mesh.triangles.size());
  for_each_range(triangles, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t != end; ++t)
      for (int c = 0; c < 3; ++c) topology.triangles[t][c] = numbers[mesh.triangles[t][c]] - 1;
  });
  return topology;
}

void add_edges(MeshTopology& topology) {
  if (topology.triangle_edges.size() == topology.triangles.size()) return;
  add_corners(topology);
  const std::size_t vertex_count = topology.vertices.size();
  std::vector<std::uint32_t> ends(vertex_count + 1, 0);  // after the sum: the number of edges before vertex v
  const auto for_vertices = [&](const auto& body) {
    for_each_range(vertex_count, kGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<HalfEdge> edges;
      for (std::size_t v = begin; v != end; ++v) {
        list_edges(topology, static_cast<std::uint32_t>(v), edges);
        body(v, edges);
      }
    });
  };
  for_vertices([&](std::size_t v, const std::vector<HalfEdge>& edges) {
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (e == 0 || edges[e].high != edges[e - 1].high) ++ends[v + 1];
  });
  inclusive_prefix_sum(ends);
  topology.edge_count = ends.back();
  topology.triangle_edges.resize(topology.triangles.size());
  for_vertices([&](std::size_t v, const std::vector<HalfEdge>& edges) {
    std::uint32_t number = ends[v];
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (e > 0 && edges[e].high != edges[e - 1].high) ++number;
      topology.triangle_edges[edges[e].slot / 3][edges[e].slot % 3] = number;
    }
  });
}

void add_normals(MeshTopology& topology, const SurfaceMesh& mesh) {
  if (topology.normals.size() == topology.vertices.size()) return;
  topology.normals.resize(topology.vertices.size());
  if (!topology.corners && topology.triangles.size() < kSmallMesh) {
    // This computes the same sums in the same order as below.
    for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
      const Double3 area = area_vector(mesh, mesh.triangles[t]);
      for (const std::uint32_t v : topology.triangles[t]) topology.normals[v] = topology.normals[v] + area;
    }
    return;
  }
  add_corners(topology);
  for_each_range(topology.vertices.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v != end; ++v) {
      const VertexCorners& around = *topology.corners;
      Double3 sum = {0, 0, 0};
      for (std::uint32_t a = around.offsets[v]; a < around.offsets[v + 1]; ++a)
        sum = sum + area_vector(mesh, mesh.triangles[around.corners[a] / 3]);
      topology.normals[v] = sum;
    }
  });
}

}  // namespace gatelight::neural
