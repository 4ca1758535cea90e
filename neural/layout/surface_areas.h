#pragma once

#include <cstdint>

#include "neural/layout/vector3.h"

namespace gatelight::neural {

/// World-space areas of an instance's triangles; triangles without area do not count.
struct SurfaceAreas {
  std::uint64_t count = 0;
  double sum = 0.0;
  double sum_of_squares = 0.0;

  double mean() const { return count == 0 ? 0.0 : sum / static_cast<double>(count); }
  /// The expected area of the triangle that contains a uniformly chosen point.
  double weighted_mean() const { return sum_of_squares > 0.0 ? sum_of_squares / sum : 0.0; }
};

SurfaceAreas measure_areas(const SurfaceMesh& mesh, const Transform& object_to_world);

}  // namespace gatelight::neural
