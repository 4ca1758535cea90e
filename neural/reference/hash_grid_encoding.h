#pragma once
// Trilinear interpolation in the multiresolution hash grid (Mueller et al. 2022, section 3).

#include <array>
#include <span>
#include <vector>

#include "neural/layout/hash_grid.h"
#include "neural/reference/node_weight.h"

namespace gatelight::neural::reference {

/// The index of a lattice point's entry within its level.
std::uint32_t hash_grid_entry(const HashGridLevel& level, std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// The eight corners of the position's cell at each level, with x varying fastest. The position is in the
/// unit cube.
std::vector<NodeWeight> hash_grid_nodes(const HashGridLayout& layout, const std::array<double, 3>& position);

}  // namespace gatelight::neural::reference
