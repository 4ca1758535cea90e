#include "neural/layout/hash_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "base/require.h"
#include "neural/layout/budget.h"

namespace gatelight::neural {

namespace {

// At higher resolutions a float position in [0,1] has no bits left for the position within a cell.
constexpr double kMaxHashResolution = 1 << 20;
constexpr std::uint64_t kMaxEntries = std::numeric_limits<std::uint32_t>::max();

void check(const HashGridOptions& options) {
  require(options.levels >= 1 && options.levels <= kMaxHashLevels, "hash-levels", options.levels, "1 to 16");
  require(options.features >= 1 && options.features <= 16, "hash-features", options.features, "1 to 16");
  require(options.base_resolution >= 1 && options.base_resolution <= kMaxHashResolution, "hash-base",
          options.base_resolution, "1 to 2^20");
  require(std::isfinite(options.growth) && options.growth >= 1.0f, "hash-growth", options.growth,
          "1 or more");
  require(options.memory_target != 0 || (options.log2_table_size >= 3 && options.log2_table_size <= 31),
          "hash-log2-size", options.log2_table_size, "3 to 31");
  require(options.bytes_per_feature == 2 || options.bytes_per_feature == 4, "bytes-per-feature",
          options.bytes_per_feature, "2 or 4");
}

/// Entries of a dense level, roundup8(res^3). This fits 64 bits as the resolution is at most 2^20.
std::uint64_t dense_entries(const HashGridLevel& level) {
  const std::uint64_t side = level.resolution;
  return (side * side * side + 7) / 8 * 8;
}

std::uint64_t total_entries(const HashGridLayout& layout, std::uint64_t table_size) {
  std::uint64_t sum = 0;
  for (const HashGridLevel& level : layout.levels) sum += std::min(dense_entries(level), table_size);
  return sum;
}

/// The largest table size, a multiple of 8, for which all levels fit the target.
std::uint64_t fitting_table_size(const HashGridLayout& layout, const HashGridOptions& options) {
  const std::uint64_t entry_bytes = std::uint64_t{options.features} * options.bytes_per_feature;
  const std::uint64_t limit = std::min<std::uint64_t>(options.memory_target / entry_bytes, kMaxEntries);
  if (total_entries(layout, 8) > limit)
    throw BadConfiguration({"cache-memory", mebibytes_text(options.memory_target),
                            fmt::format("MiB do not hold {} levels", layout.levels.size()),
                            "at least " + mebibytes_text(total_entries(layout, 8) * entry_bytes)});
  std::uint64_t fits = 1, too_many = (std::uint64_t{1} << 32) / 8;  // in multiples of 8
  while (too_many - fits > 1) {
    const std::uint64_t middle = (fits + too_many) / 2;
    (total_entries(layout, 8 * middle) <= limit ? fits : too_many) = middle;
  }
  return 8 * fits;
}

}  // namespace

HashGridLayout build_position_mapping(const HashGridOptions& options) {
  float longest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = options.bounds_min[axis], high = options.bounds_max[axis];
    if (!std::isfinite(low) || !std::isfinite(high) || !(low <= high) || !std::isfinite(high - low))
      throw BadConfiguration(fmt::format(
          "hash grid bounds of axis {}: {} to {}, expected finite and in order", axis, low, high));
    longest = std::max(longest, high - low);
  }
  const float inverse = 1.0f / longest;
  if (!std::isfinite(inverse) || inverse <= 0.0f)
    throw BadConfiguration(
        fmt::format("hash grid bounds: the longest side is {}, expected more than 0", longest));
  HashGridLayout layout;
  layout.bounds_min = options.bounds_min;
  layout.inverse_extent = inverse;
  return layout;
}

HashGridLayout build_hash_grid_layout(const HashGridOptions& options) {
  check(options);
  HashGridLayout layout = build_position_mapping(options);
  layout.features = options.features;
  for (std::uint32_t l = 0; l < options.levels; ++l) {
    const double scale = options.base_resolution * std::pow(static_cast<double>(options.growth), l) - 1.0;
    if (!(scale < kMaxHashResolution))
      throw BadConfiguration(
          {"hash-growth", "", fmt::format("the finest resolution is {}", scale + 1.0), "at most 2^20"});
    HashGridLevel level;
    level.scale = static_cast<float>(scale);
    level.resolution = static_cast<std::uint32_t>(std::ceil(level.scale)) + 1;
    layout.levels.push_back(level);
  }
  const std::uint64_t table_size = options.memory_target != 0 ? fitting_table_size(layout, options)
                                                              : std::uint64_t{1} << options.log2_table_size;
  const std::uint64_t nodes = total_entries(layout, table_size);
  if (nodes > kMaxEntries)
    throw BadConfiguration({"hash-levels", "", fmt::format("they have {} entries", nodes), "less than 2^32"});
  for (HashGridLevel& level : layout.levels) {
    const std::uint64_t side = level.resolution;
    level.entries = static_cast<std::uint32_t>(std::min(dense_entries(level), table_size));
    level.dense = side * side * side <= level.entries ? 1 : 0;
    level.first_node = layout.node_count;
    layout.node_count += level.entries;
  }
  return layout;
}

}  // namespace gatelight::neural
