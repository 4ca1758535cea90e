#include "neural/layout/vertex_corners.h"

#include <tbb/parallel_sort.h>

#include <atomic>

#include "base/parallel/loops.h"
#include "neural/layout/prefix_sum.h"

namespace gatelight::neural {

VertexCorners build_vertex_corners(std::span<const TriangleCorners> triangles, std::uint32_t vertex_count) {
  VertexCorners result;
  result.offsets.assign(vertex_count + std::size_t{1}, 0);
  result.corners.resize(3 * triangles.size());
  std::vector<std::uint32_t>& offsets = result.offsets;
  // The sums are the ends of the lists; the scatter counts each down to its beginning.
  for_each_range(triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t != end; ++t)
      for (const std::uint32_t v : triangles[t])
        std::atomic_ref(offsets[v]).fetch_add(1, std::memory_order_relaxed);
  });
  inclusive_prefix_sum(offsets);
  for_each_range(triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t != end; ++t)
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t slot =
            std::atomic_ref(offsets[triangles[t][c]]).fetch_sub(1, std::memory_order_relaxed) - 1;
        result.corners[slot] = static_cast<std::uint32_t>(3 * t + c);
      }
  });
  // The order of the scatter depends on the threads, so the lists are sorted.
  for_each_range(vertex_count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v != end; ++v) {
      tbb::parallel_sort(result.corners.begin() + offsets[v], result.corners.begin() + offsets[v + 1]);
    }
  });
  return result;
}

}  // namespace gatelight::neural
