#pragma once
// One record of a batch in double precision.

#include <array>
#include <cstddef>
#include <cstdint>

#include "neural/model/batch.h"
#include "neural/model/model.h"

namespace gatelight::neural::reference {

/// Inputs that the model does not read keep their defaults.
struct Point {
  std::uint32_t surface = 0;
  std::uint32_t triangle = 0;
  std::array<double, 3> barycentrics = {1, 0, 0};  ///< weights of all three corners
  std::array<double, 3> position = {0, 0, 0};      ///< in the unit cube
  std::array<double, 3> direction = {0, 0, 1};
  std::array<double, 3> normal = {0, 0, 1};
  std::array<double, 3> albedo = {0, 0, 0};
  double roughness = 0;
};

Point read_point(const Model& model, const QueryBatch& batch, std::size_t record);

}  // namespace gatelight::neural::reference
