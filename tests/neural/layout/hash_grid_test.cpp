#include "neural/layout/hash_grid.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/errors.h"

namespace gatelight::neural {
namespace {

std::uint64_t bytes(const HashGridLayout& layout, const HashGridOptions& options) {
  return std::uint64_t{layout.node_count} * options.features * options.bytes_per_feature;
}

TEST(HashGrid, LevelsGrowFromTheBaseAndAreDenseWhereTheyFit) {
  // The paper's 8 x 4 at base 2, growth 2: 2, 4, ..., 256 cells a side.
  HashGridOptions options{.log2_table_size = 15};
  const HashGridLayout layout = build_hash_grid_layout(options);
  ASSERT_EQ(layout.levels.size(), 8u);
  EXPECT_EQ(layout.features, 4u);
  std::uint32_t first = 0;
  for (std::uint32_t l = 0; l < 8; ++l) {
    const HashGridLevel& level = layout.levels[l];
    const std::uint32_t side = 2u << l;
    EXPECT_EQ(level.scale, static_cast<float>(side - 1));
    EXPECT_EQ(level.resolution, side);
    EXPECT_EQ(level.dense, l < 5 ? 1u : 0u);  // 32^3 = 2^15 fits exactly
    EXPECT_EQ(level.entries, l < 5 ? side * side * side : 1u << 15);
    EXPECT_EQ(level.first_node, first);
    first += level.entries;
  }
  EXPECT_EQ(layout.node_count, first);
}

TEST(HashGrid, EntriesOfADenseLevelAreRoundedUpToEight) {
  // Scales 2, 3.5, 5.75.
  HashGridOptions options{.levels = 3, .base_resolution = 3, .growth = 1.5f};
  const HashGridLayout layout = build_hash_grid_layout(options);
  EXPECT_EQ(layout.levels[0].entries, 32u);  // 27
  EXPECT_EQ(layout.levels[1].resolution, 5u);
  EXPECT_EQ(layout.levels[1].entries, 128u);  // 125
  EXPECT_EQ(layout.levels[2].resolution, 7u);
  EXPECT_EQ(layout.levels[2].entries, 344u);  // 343
}

TEST(HashGrid, MemoryTargetIsMetWithinOneStepOfTheTableSize) {
  for (const std::uint32_t features : {1u, 2u, 4u, 7u, 16u})
    for (const std::uint32_t bytes_per_feature : {2u, 4u})
      for (const std::uint64_t target : {1000000ull, 910000ull, 83090000ull, 132240000ull, 4000000000ull}) {
        const HashGridOptions options{
            .features = features, .memory_target = target, .bytes_per_feature = bytes_per_feature};
        const HashGridLayout layout = build_hash_grid_layout(options);
        std::uint64_t hashed = 0, table = 0;
        for (const HashGridLevel& level : layout.levels)
          if (level.dense == 0) ++hashed, table = level.entries;
        EXPECT_LE(bytes(layout, options), target);
        EXPECT_EQ(table % 8, 0u);
        if (hashed > 0) {
          // Eight more entries for every hashed level would exceed the target.
          EXPECT_GT(bytes(layout, options) + hashed * 8 * features * bytes_per_feature, target);
        }
      }
}

TEST(HashGrid, ATargetForAllLevelsMakesAllDense) {
  HashGridOptions options{.levels = 5, .memory_target = std::numeric_limits<std::uint64_t>::max()};
  for (const HashGridLevel& level : build_hash_grid_layout(options).levels) EXPECT_EQ(level.dense, 1u);
  // All levels have more entries than 32 bits can number: the layout has as many as they can.
  options.levels = 16;
  const std::uint32_t nodes = build_hash_grid_layout(options).node_count;
  EXPECT_GT(nodes, std::numeric_limits<std::uint32_t>::max() - 16 * 8);
}

TEST(HashGrid, FineResolutionsDoNotOverflow) {
  // 2^19 a side: 2^57 lattice points.
  HashGridOptions options{.levels = 16, .base_resolution = 16, .growth = 2.0f};
  const HashGridLayout layout = build_hash_grid_layout(options);
  EXPECT_EQ(layout.levels[15].resolution, 1u << 19);
  EXPECT_EQ(layout.levels[15].entries, 1u << 19);
  EXPECT_EQ(layout.levels[15].dense, 0u);
  // 2^16 and 2^11 a side: their cubes are 0 in 48 and 32 bits.
  EXPECT_EQ(layout.levels[12].dense, 0u);
  EXPECT_EQ(layout.levels[7].dense, 0u);
}

TEST(HashGrid, LongestSideOfTheBoundsFillsTheUnitInterval) {
  // Flat in z.
  HashGridOptions options{.bounds_min = {-1, 2, 3}, .bounds_max = {1, 6, 3}};
  const HashGridLayout layout = build_hash_grid_layout(options);
  EXPECT_EQ(layout.bounds_min, options.bounds_min);
  EXPECT_EQ(layout.inverse_extent, 0.25f);
  const HashGridLayout mapping = build_position_mapping(options);
  EXPECT_EQ(mapping.inverse_extent, 0.25f);
  EXPECT_TRUE(mapping.levels.empty());
}

TEST(HashGrid, OptionsOutOfRangeAreRefused) {
  const auto refuses = [](auto change) {
    HashGridOptions options;
    change(options);
    EXPECT_THROW(build_hash_grid_layout(options), BadConfiguration);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  refuses([](HashGridOptions& o) { o.levels = 0; });
  refuses([](HashGridOptions& o) { o.levels = 17; });
  refuses([](HashGridOptions& o) { o.features = 0; });
  refuses([](HashGridOptions& o) { o.features = 17; });
  refuses([](HashGridOptions& o) { o.base_resolution = 0; });
  refuses([](HashGridOptions& o) { o.growth = 0.5f; });
  refuses([](HashGridOptions& o) { o.growth = kNan; });
  refuses([](HashGridOptions& o) { o.growth = 1e30f; });
  refuses([](HashGridOptions& o) { o.log2_table_size = 2; });
  refuses([](HashGridOptions& o) { o.log2_table_size = 32; });
  refuses([](HashGridOptions& o) { o.bytes_per_feature = 3; });
  refuses([](HashGridOptions& o) { o.memory_target = 1000; });  // 8 levels of at least 8 x 4 x 4 bytes
  refuses([](HashGridOptions& o) { o.bounds_max = {0, 0, 0}; });
  refuses([](HashGridOptions& o) { o.bounds_max = {-1, 1, 1}; });
  refuses([](HashGridOptions& o) { o.bounds_max = {1, kNan, 1}; });
  refuses([](HashGridOptions& o) { o.bounds_min = {-3e38f, 0, 0}, o.bounds_max = {3e38f, 1, 1}; });
  refuses([](HashGridOptions& o) {
    o.levels = 16, o.growth = 2, o.base_resolution = 16, o.log2_table_size = 31;
  });
}

}  // namespace
}  // namespace gatelight::neural
