// Radiance that is passed back along chains of vertices, against results by hand; records of one training
// point merged into one.

#include "renderer/cache/path_batch.h"

#include <gtest/gtest.h>

#include <array>

namespace gatelight::renderer {
namespace {

void push_point(SurfacePoints& points, std::uint32_t triangle, float u = 0.25f) {
  Hit hit;
  hit.t = 1.0f;
  hit.u = u;
  hit.v = 0.5f;
  hit.instance = 0;
  hit.primitive = triangle;
  points.push_back(surface_point(hit, 0, Vec3(0, 0, 1), Surface{}, Color::Ones()));
}

Color target(const PathBatch& batch, std::size_t record) {
  return Eigen::Map<const Color>(&batch.targets[3 * record]);
}

TEST(PathBatch, LightComesBackThroughPanesAnswersAndRecords) {
  PathBatch batch;
  batch.begin(2);
  batch.emission[0] = Color(8.0f, 0.0f, 16.0f);  // the first visible surface emits
  batch.emission[1] = Color(0.5f, 1.0f, 2.0f);   // the second path sees the sky

  PathVertex wall;  // a record behind a pane
  wall.link = Color(0.5f, 0.25f, 1.0f);
  wall.direct = Color(3.0f, 5.0f, 9.0f);
  wall.reflectance = Color(0.5f, 0.25f, 0.125f);
  wall.record = 0;
  push_point(batch.records, 7);
  batch.targets = {1.5f, 2.5f, 3.5f};

  PathVertex end;  // queries the cache, and goes on by a narrow lobe
  end.previous = 0;
  end.link = Color(0.375f, 0.5f, 0.5f);
  end.cached_link = Color(0.25f, 0.25f, 0.125f);
  end.direct = Color(2.0f, 3.0f, 4.0f);
  end.reflectance = Color(0.5f, 0.75f, 1.0f);
  end.query = 0;
  push_point(batch.queries, 9);

  PathVertex mirrored;  // the last vertex, without record and query
  mirrored.previous = 1;
  mirrored.link = Color(0.25f, 0.25f, 1.5f);
  mirrored.cached_link = Color(9.0f, 9.0f, 9.0f);  // no record is there to store it
  mirrored.direct = Color(4.0f, 8.0f, 2.0f);
  batch.vertices = {wall, end, mirrored};

  const std::array<float, 3> answers{10.0f, 20.0f, 30.0f};
  std::array<Color, 2> radiance;
  batch.resolve(answers, radiance);

  // Back from the last vertex:
  // R(end) = (2,3,4) + (.5,.75,1)(10,20,30) + (.25,.25,1.5)(4,8,2) = (8, 20, 37).
  // R(wall) = (3,5,9) + (.375,.5,.5)(8,20,37) = (6, 15, 27.5).
  // H(wall) = (1.5,2.5,3.5) + (.25,.25,.125)(8,20,37) = (3.5, 7.5, 8.125).
  ASSERT_EQ(batch.targets.size(), 3u);
  EXPECT_TRUE((target(batch, 0) == Color(7.0f, 30.0f, 65.0f)).all()) << target(batch, 0).transpose();
  EXPECT_TRUE((radiance[0] == Color(8.0f + 3.0f, 3.75f, 16.0f + 27.5f)).all()) << radiance[0].transpose();
  EXPECT_TRUE((radiance[1] == Color(0.5f, 1.0f, 2.0f)).all()) << radiance[1].transpose();
}

TEST(PathBatch, FirstHitsGetTheCacheRadianceOfEachPath) {
  PathBatch batch;
  batch.begin(3);
  batch.guides.resize(3);
  batch.emission[0] = Color(8.0f, 0.0f, 16.0f);
  batch.emission[1] = Color(0.5f, 1.0f, 2.0f);  // sees the sky: no guide

  PathVertex mirror;  // of the first path, lit by a lamp that it shows
  mirror.link = Color(0.5f, 0.25f, 1.0f);
  mirror.direct = Color(3.0f, 5.0f, 9.0f);
  PathVertex wall;  // behind the mirror: the guide
  wall.previous = 0;
  wall.link = Color(0.5f, 1.0f, 0.25f);
  wall.direct = Color(100.0f, 100.0f, 100.0f);  // found by the path, but part of the cached light
  PathVertex beyond;
  beyond.previous = 1;
  beyond.direct = Color(50.0f, 50.0f, 50.0f);
  PathVertex glass;  // of the third path, which meets nothing wide
  glass.path = 2;
  glass.direct = Color(4.0f, 8.0f, 2.0f);
  glass.link = Color(0.25f, 0.5f, 1.0f);
  batch.vertices = {mirror, wall, beyond, glass};
  batch.guides[0] = {1, 0, Color(0.5f, 0.75f, 1.0f), Color(1.0f, 2.0f, 4.0f)};
  push_point(batch.queries, 9);

  const std::array<float, 3> answers{10.0f, 20.0f, 30.0f};
  std::vector<FirstHit> hits(3);
  batch.write_guides(answers, hits);
  const auto is = [&](std::size_t path, const Color& color) {
    return hits[path].guided && (hits[path].cache_radiance == color).all();
  };
  // The wall: (.5,.75,1)(10,20,30) + (1,2,4) = (6,17,34). The mirror: (3,5,9) + (.5,1,.25)(6,17,34).
  EXPECT_TRUE(is(0, Color(8.0f + 3.0f, 5.5f, 16.0f + 17.5f))) << hits[0].cache_radiance.transpose();
  EXPECT_TRUE(is(1, Color(0.5f, 1.0f, 2.0f))) << hits[1].cache_radiance.transpose();
  EXPECT_TRUE(is(2, Color(1.0f, 4.0f, 2.0f))) << hits[2].cache_radiance.transpose();
}

/// Records given by their triangles, each with 3 targets of its number.
PathBatch recorded(const std::vector<std::uint32_t>& triangles, std::vector<std::int32_t> first_records) {
  PathBatch batch;
  for (const std::uint32_t t : triangles) push_point(batch.records, t);
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
