#include "neural/reference/hash_grid_encoding.h"

#include <algorithm>
#include <cmath>

namespace gatelight::neural::reference {

std::uint32_t hash_grid_entry(const HashGridLevel& level, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const std::uint32_t index = level.dense != 0
                                  ? x + y * level.resolution + z * level.resolution * level.resolution
                                  : x ^ y * 2654435761u ^ z * 805459861u;
  return index % level.entries;
}

std::vector<NodeWeight> hash_grid_nodes(const HashGridLayout& layout, const std::array<double, 3>& position) {
  std::vector<NodeWeight> nodes;
  for (const HashGridLevel& level : layout.levels) {
    std::array<std::uint32_t, 3> cell;
    std::array<double, 3> fraction;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scaled = position[axis] * level.scale + 0.5;
      cell[axis] = static_cast<std::uint32_t>(scaled);
      fraction[axis] = scaled - cell[axis];
    }
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const std::array<std::uint32_t, 3> step = {corner & 1, corner >> 1 & 1, corner >> 2};
      double weight = 1.0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        weight *= step[axis] == 1 ? fraction[axis] : 1.0 - fraction[axis];
      const std::uint32_t entry =
          hash_grid_entry(level, cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]);
      nodes.push_back({level.first_node + entry, weight});
    }
  }
  return nodes;
}

}  // namespace gatelight::neural::reference
