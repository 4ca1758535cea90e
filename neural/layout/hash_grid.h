#pragma once
// The multiresolution hash grid of Mueller et al., "Instant Neural Graphics Primitives" (2022): the paper's
// baseline.

#include <array>
#include <cstdint>
#include <vector>

#include "neural/base/batch.h"

namespace gatelight::neural {

inline constexpr std::uint32_t kMaxHashLevels = 16;

struct HashGridOptions {
  std::uint32_t levels = 8;
  std::uint32_t features = 4;  ///< floats an entry, 1 to 16
  std::uint32_t base_resolution = 2;
  float growth = 2.0f;                 ///< of the resolution from one level to the next
  std::uint32_t log2_table_size = 19;  ///< most entries of a level
  /// Bytes for all levels, 0 to use log2_table_size: the greatest table size (a multiple of 8, not only
  /// powers of two) that fits is taken.
  std::uint64_t memory_target = 0;
  std::uint32_t bytes_per_feature = 4;
  Float3 bounds_min = {0, 0, 0};  ///< positions are mapped so that the bounds' longest side fills [0,1];
  Float3 bounds_max = {1, 1, 1};  ///< what lies outside is clamped to the bounds
};

/// Level l: scale = base growth^l - 1, resolution = ceil(scale) + 1; a point x in [0,1]^3 lies at x scale +
/// 0.5; dense (x + y res + z res^2) where res^3 entries fit, else x ^ y 2654435761 ^ z 805459861 (32 bits).
/// Both mod entries: a cell at the far border has corners with a coordinate of res, so that a dense index can
/// be beyond the entries, though less than twice.
struct HashGridLevel {
  float scale = 0.0f;
  std::uint32_t resolution = 0;
  std::uint32_t entries = 0;
  std::uint32_t first_node = 0;
  std::uint32_t dense = 0;  ///< 1: dense
};

struct HashGridLayout {
  std::uint32_t features = 0;
  std::uint32_t node_count = 0;
  std::vector<HashGridLevel> levels;
  Float3 bounds_min = {0, 0, 0};
  /// Unit position = (position - bounds_min) * inverse_extent, clamped to [0,1]: in float, rounded twice, in
  /// every backend, as high frequencies and fine levels magnify the rounding.
  float inverse_extent = 1.0f;
};

/// Throws BadConfiguration for options out of range or bounds that are empty or not finite.
HashGridLayout build_hash_grid_layout(const HashGridOptions& options);

/// A layout without levels: only how the bounds map positions to the unit cube. Throws like the other.
HashGridLayout build_position_mapping(const HashGridOptions& options);

}  // namespace gatelight::neural
