#pragma once
// The multiresolution hash grid of Mueller et al., "Instant Neural Graphics Primitives" (2022), the baseline
// of the GATE paper.

#include <array>
#include <cstdint>
#include <vector>

#include "neural/layout/vector_types.h"

namespace gatelight::neural {

inline constexpr std::uint32_t kMaxHashLevels = 16;

struct HashGridOptions {
  std::uint32_t levels = 8;
  std::uint32_t features = 4;  ///< floats per entry, 1 to 16
  std::uint32_t base_resolution = 2;
  float growth = 2.0f;                 ///< ratio of the resolutions of successive levels
  std::uint32_t log2_table_size = 19;  ///< log2 of the maximum entries of a level
  /// Bytes for all levels; 0 means log2_table_size decides. Otherwise the largest table size that fits is
  /// used: a multiple of 8, not necessarily a power of two.
  std::uint64_t memory_target = 0;
  std::uint32_t bytes_per_feature = 4;
  Float3 bounds_min = {0, 0, 0};  ///< the bounds' longest side is mapped to [0,1]
  Float3 bounds_max = {1, 1, 1};  ///< positions outside are clamped to the bounds
};

/// Level l has scale = base growth^l - 1 and resolution res = ceil(scale) + 1. A point x in [0,1]^3 lies at x
/// scale + 0.5. The index of a corner is x + y res + z res^2 (dense) if res^3 entries fit, else x ^ y
/// 2654435761 ^ z 805459861 (32 bits). Both are taken modulo `entries`: corners of a cell at the far border
/// have a coordinate of res, so a dense index can exceed `entries`, but not twice its value.
struct HashGridLevel {
  float scale = 0.0f;
  std::uint32_t resolution = 0;
  std::uint32_t entries = 0;
  std::uint32_t first_node = 0;
  std::uint32_t dense = 0;  ///< 1 if dense, else 0
};

struct HashGridLayout {
  std::uint32_t features = 0;
  std::uint32_t node_count = 0;
  std::vector<HashGridLevel> levels;
  Float3 bounds_min = {0, 0, 0};
  /// Unit position = (position - bounds_min) * inverse_extent, clamped to [0,1]. Every backend computes it in
  /// float with two roundings, because high frequencies and fine levels magnify rounding differences.
  float inverse_extent = 1.0f;
};

/// Throws BadConfiguration for options out of range and for bounds that are empty or not finite.
HashGridLayout build_hash_grid_layout(const HashGridOptions& options);

/// A layout without levels that only maps positions to the unit cube. Throws BadConfiguration for the bounds.
HashGridLayout build_position_mapping(const HashGridOptions& options);

}  // namespace gatelight::neural
