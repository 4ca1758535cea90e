#include "neural/reference/point.h"

#include <algorithm>

namespace gatelight::neural::reference {

namespace {

std::array<double, 3> widen(const Float3& v) {
  return {v[0], v[1], v[2]};
}

// NaN becomes 0, because comparisons with NaN are false.
double clamp_unit(double x) {
  return x > 0.0 ? std::min(x, 1.0) : 0.0;
}

}  // namespace

Point read_point(const Model& model, const QueryBatch& batch, std::size_t record) {
  const ModelConfig& config = model.config;
  Point point;
  if (config.encoding == FeatureEncoding::gate) {
    point.surface = batch.surfaces[record];
    point.triangle = batch.triangles[record];
    const double second = batch.barycentrics[record][0], third = batch.barycentrics[record][1];
    point.barycentrics = {1.0 - second - third, second, third};
  }
  if (uses_input(config, InputSource::position)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float offset = batch.positions[record][axis] - model.hash_grid.bounds_min[axis];
      point.position[axis] = clamp_unit(offset * model.hash_grid.inverse_extent);
    }
  }
  if (uses_input(config, InputSource::direction)) point.direction = widen(batch.directions[record]);
  if (uses_input(config, InputSource::normal)) point.normal = widen(batch.normals[record]);
  if (uses_input(config, InputSource::albedo)) point.albedo = widen(batch.albedos[record]);
  if (uses_input(config, InputSource::roughness)) point.roughness = batch.roughnesses[record];
  return point;
}

}  // namespace gatelight::neural::reference
