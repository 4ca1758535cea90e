// Light on its way back along chains of vertices, worked by hand; records of one training point as one.

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
  points.push_back(hit, 0, Vec3(0, 0, 1), Surface{}, Color::Ones());
}

PathVertex eye() {
  PathVertex root;
  root.emission_weight = root.scattered_weight = Color::Ones();
  return root;
}

Color target(const PathBatch& batch, std::size_t record) {
  return Eigen::Map<const Color>(&batch.targets[3 * record]);
}

TEST(PathBatch, LightComesBackThroughPanesAnswersAndRecords) {
  PathBatch batch;
  batch.first_records = batch.first_queries = {0, kNone};
  PathVertex root = eye();
  root.emission = Color(8.0f, 0.0f, 16.0f);  // what the eye sees first shines
  batch.vertices = {root, eye()};
  batch.vertices[1].emission = Color(0.5f, 1.0f, 2.0f);  // the second path sees the sky

  PathVertex wall;  // a record behind a pane
  wall.previous = 0;
  wall.passed = Color(0.5f, 0.25f, 1.0f);
  wall.direct = Color(2.0f, 4.0f, 8.0f);
  wall.emission = Color(4.0f, 2.0f, 1.0f);
  wall.emission_weight = Color(0.25f, 0.5f, 1.0f);
  wall.scattered_weight = Color(0.75f, 0.5f, 0.25f);
  wall.held_direct = Color(1.0f, 2.0f, 3.0f);
  wall.held_emission_weight = Color(0.125f, 0.25f, 0.5f);
  wall.held_scattered_weight = Color(0.5f, 0.25f, 0.125f);
  wall.reflectance = Color(0.5f, 0.25f, 0.125f);
  wall.record = 0;
  push_point(batch.records, 7);

  PathVertex end;  // asks the cache, and goes on by a narrow lobe
  end.previous = 2;
  end.passed = Color(0.5f, 1.0f, 2.0f);
  end.direct = Color(1.0f, 2.0f, 3.0f);
  end.emission = Color(2.0f, 4.0f, 8.0f);
  end.emission_weight = Color(0.5f, 0.25f, 0.125f);
  end.scattered_weight = Color(0.25f, 0.5f, 0.75f);
  end.reflectance = Color(0.5f, 0.75f, 1.0f);
  end.query = 0;
  push_point(batch.queries, 9);

  PathVertex mirrored;  // the last, without anything of the cache
  mirrored.previous = 3;
  mirrored.passed = Color(1.0f, 0.5f, 2.0f);
  mirrored.direct = Color(4.0f, 8.0f, 2.0f);
  batch.vertices.insert(batch.vertices.end(), {wall, end, mirrored});

  const std::array<float, 3> answers{10.0f, 20.0f, 30.0f};
  std::array<Color, 2> radiance;
  batch.resolve(answers, radiance);

  // Back from the last: S(end) = (4, 4, 4).
  // R(end) = (1,2,3) + (.5,.75,1)(10,20,30) + (.5,.25,.125)(2,4,8) + (.25,.5,.75) 4 = (8, 20, 37).
  // S(wall) = (.5,1,2) R(end) = (4, 20, 74).
  // R(wall) = (2,4,8) + (.25,.5,1)(4,2,1) + (.75,.5,.25)(4,20,74) = (6, 15, 27.5).
  // H(wall) = (1,2,3) + (.125,.25,.5)(4,2,1) + (.5,.25,.125)(4,20,74) = (3.5, 7.5, 12.75).
  ASSERT_EQ(batch.targets.size(), 3u);
  EXPECT_TRUE((target(batch, 0) == Color(7.0f, 30.0f, 102.0f)).all()) << target(batch, 0).transpose();
  EXPECT_TRUE((radiance[0] == Color(8.0f + 3.0f, 3.75f, 16.0f + 27.5f)).all()) << radiance[0].transpose();
  EXPECT_TRUE((radiance[1] == Color(0.5f, 1.0f, 2.0f)).all()) << radiance[1].transpose();
}

TEST(PathBatch, RadianceIsOptional) {
  PathBatch batch;
  batch.vertices = {eye()};
  PathVertex wall;
  wall.previous = 0;
  wall.held_direct = Color(1.0f, 2.0f, 3.0f);
  wall.reflectance = Color(0.5f, 0.5f, 0.5f);
  wall.record = 0;
  batch.vertices.push_back(wall);
  push_point(batch.records, 1);
  batch.resolve({}, {});
  EXPECT_TRUE((target(batch, 0) == Color(2.0f, 4.0f, 6.0f)).all());
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
  // Two points, three paths each: the first leaves records 0 1, 2 3, 4; the second 5, none, 6 7.
  PathBatch batch =
      recorded({10, 100, 10, 101, 10, 20, 20, 102}, std::vector<std::int32_t>{0, 2, 4, 5, kNone, 6});
  batch.average_first_records(3);
  EXPECT_EQ(triangles_of(batch), (std::vector<std::uint32_t>{10, 100, 101, 20, 102}));
  const float expected[] = {(0.0f + 4.0f + 16.0f) / 3.0f, 1.0f, 9.0f, (25.0f + 36.0f) / 2.0f, 49.0f};
  ASSERT_EQ(batch.targets.size(), 15u);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_FLOAT_EQ(batch.targets[3 * i + c], expected[i] + static_cast<float>(c)) << i;
  }
}

TEST(PathBatch, APointWhoseFirstPathLeftNothingIsAveragedAllTheSame) {
  PathBatch batch = recorded({10, 10}, {kNone, 0, 1});
  batch.average_first_records(3);
  EXPECT_EQ(triangles_of(batch), (std::vector<std::uint32_t>{10}));
  EXPECT_FLOAT_EQ(batch.targets[0], 0.5f);
}

TEST(PathBatch, FirstRecordsAtDifferentPointsStayApart) {
  // Behind glass: two paths were reflected to one point, two refracted to another.
  PathBatch batch = recorded({10, 20, 10, 20}, {0, 1, 2, 3});
  batch.average_first_records(4);
  EXPECT_EQ(triangles_of(batch), (std::vector<std::uint32_t>{10, 20}));
  EXPECT_FLOAT_EQ(batch.targets[0], 2.0f);
  EXPECT_FLOAT_EQ(batch.targets[3], 5.0f);
}

TEST(PathBatch, OnePathAPointChangesNothing) {
  PathBatch batch = recorded({1, 2, 3}, {0, kNone, 2});
  const std::vector<float> targets = batch.targets;
  batch.average_first_records(1);
  EXPECT_EQ(triangles_of(batch), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(batch.targets, targets);
}

}  // namespace
}  // namespace gatelight::renderer
