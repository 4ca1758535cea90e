// Records of one training point are merged into one.

#include "renderer/cache/path_batch.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

/// Records given by their triangles, each with 3 targets of its number.
PathBatch recorded(const std::vector<std::uint32_t>& triangles, std::vector<std::int32_t> first_records) {
  PathBatch batch;
  for (const std::uint32_t t : triangles) {
    Hit hit;
    hit.primitive = t;
    batch.records.push_back(surface_point(hit, 0, Vec3::UnitZ(), Surface{}, Color::Ones()));
  }
  batch.first_records = std::move(first_records);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      batch.targets.push_back(static_cast<float>(i * i + static_cast<std::size_t>(c)));
  }
  return batch;
}

std::vector<std::uint32_t> triangles_of(const PathBatch& batch) {
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 0; i < batch.records.size(); ++i) triangles.push_back(batch.records.triangle(i));
  return triangles;
}

TEST(PathBatch, FirstRecordsOfAPointBecomeTheirMeanAndOthersKeepTheirOrder) {
  struct Row {
    const char* name;
    std::vector<std::uint32_t> triangles;
    std::vector<std::int32_t> first_records;
    std::size_t paths;  ///< of a point
    std::vector<std::uint32_t> left;
    std::vector<float> means;
  };
  const Row rows[] = {
      // Two points: the first leaves records 0 1, 2 3, 4; the second 5, none, 6 7.
      {"others between them",
       {10, 100, 10, 101, 10, 20, 20, 102},
       {0, 2, 4, 5, kNone, 6},
       3,
       {10, 100, 101, 20, 102},
       {20.0f / 3.0f, 1.0f, 9.0f, 61.0f / 2.0f, 49.0f}},
      {"the first path left none", {10, 10}, {kNone, 0, 1}, 3, {10}, {0.5f}},
      {"two were reflected, two refracted", {10, 20, 10, 20}, {0, 1, 2, 3}, 4, {10, 20}, {2.0f, 5.0f}},
      {"one path a point", {1, 2, 3}, {0, kNone, 2}, 1, {1, 2, 3}, {0.0f, 1.0f, 4.0f}}};
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    PathBatch batch = recorded(row.triangles, row.first_records);
    batch.average_first_records(row.paths);
    EXPECT_EQ(triangles_of(batch), row.left);
    ASSERT_EQ(batch.targets.size(), 3 * row.means.size());
    for (std::size_t i = 0; i < batch.targets.size(); ++i)
      EXPECT_FLOAT_EQ(batch.targets[i], row.means[i / 3] + static_cast<float>(i % 3));
  }
}

}  // namespace
}  // namespace gatelight::renderer
