#pragma once

#include <cstdint>

#include "neural/layout/vector3.h"

namespace gatelight::neural {

/// Over the triangles of an instance that have an area, in world space.
struct SurfaceAreas {
  std::uint64_t count = 0;
  double sum = 0.0;
  double sum_of_squares = 0.0;

  double mean() const { return count == 0 ? 0.0 : sum / static_cast<double>(count); }
  /// The area of the triangle that a uniformly chosen point lies on, on average.
  double weighted_mean() const { return sum_of_squares > 0.0 ? sum_of_squares / sum : 0.0; }
};

SurfaceAreas measure_areas(const SurfaceMesh& mesh, const Transform& object_to_world);

}  // namespace gatelight::neural
