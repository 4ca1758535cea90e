#include "neural/layout/surface_areas.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace gatelight::neural {

SurfaceAreas measure_areas(const SurfaceMesh& mesh, const Transform& object_to_world) {
  const Transform to_world = cofactors(object_to_world);
  return tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 8192), SurfaceAreas{},
      [&](const tbb::blocked_range<std::size_t>& range, SurfaceAreas sums) {
        for (std::size_t t = range.begin(); t != range.end(); ++t) {
          const double area = 0.5 * length(transform_vector(to_world, area_vector(mesh, mesh.triangles[t])));
          if (!(area > 0.0)) continue;
          ++sums.count;
          sums.sum += area;
          sums.sum_of_squares += area * area;
        }
        return sums;
      },
      [](const SurfaceAreas& a, const SurfaceAreas& b) {
        return SurfaceAreas{a.count + b.count, a.sum + b.sum, a.sum_of_squares + b.sum_of_squares};
      });
}

}  // namespace gatelight::neural
