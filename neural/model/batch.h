#pragma once
// Batches of queries and training records: structures of arrays over points on surfaces. Each span has one
// entry per point. Spans that the model does not read may be empty.

#include <cstddef>
#include <cstdint>
#include <span>

#include "neural/layout/vector_types.h"

namespace gatelight::neural {

/// Points on surfaces. Directions and normals are unit vectors in one space of the caller's choice (world).
struct QueryBatch {
  std::span<const std::uint32_t> surfaces;   ///< surface_index(instance, side); gate only
  std::span<const std::uint32_t> triangles;  ///< index within the instance's mesh; gate only
  std::span<const Float2> barycentrics;      ///< weights of the triangle's second and third corner; gate only
  std::span<const Float3> positions;  ///< in the space of the hash grid's bounds; hash grid or position input
  std::span<const Float3> directions;  ///< from the point back along the path (outgoing)
  std::span<const Float3> normals;
  std::span<const Float3> albedos;
  std::span<const float> roughnesses;
  std::size_t size = 0;
};

struct TrainingBatch {
  QueryBatch points;
  std::span<const float> targets;  ///< points.size x outputs, row-major
};

}  // namespace gatelight::neural
