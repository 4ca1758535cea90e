// Points as growing arrays: the inputs that are stored, copying, and the view as a batch.

#include "renderer/cache/surface_points.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

PointInputs everything() {
  PointInputs inputs;
  inputs.positions = inputs.directions = inputs.normals = inputs.albedos = inputs.roughnesses = true;
  return inputs;
}

/// Appends a point whose values all encode `number`.
void push(SurfacePoints& points, int number) {
  const auto f = static_cast<float>(number);
  Hit hit;
  hit.t = 1.0f;
  hit.u = 0.01f * f;
  hit.v = 0.02f * f;
  hit.instance = static_cast<std::uint32_t>(number);
  hit.primitive = static_cast<std::uint32_t>(100 + number);
  Surface surface;
  surface.position = Vec3(f, f + 0.25f, f + 0.5f);
  surface.shading_normal = Vec3(0.0f, f, 1.0f);
  surface.geometric_normal = Vec3(-1.0f, -1.0f, -1.0f);
  surface.material.roughness = 0.1f * f;
  points.push_back(surface_point(hit, static_cast<std::uint32_t>(number % 2), Vec3(1.0f, 0.0f, f), surface,
                                 Color(0.3f * f, 0.2f * f, 0.1f * f)));
}

void expect_point(const neural::QueryBatch& batch, std::size_t i, int number) {
  const auto f = static_cast<float>(number);
  EXPECT_EQ(batch.surfaces[i], neural::surface_index(static_cast<std::uint32_t>(number),
                                                     static_cast<std::uint32_t>(number % 2)));
  EXPECT_EQ(batch.triangles[i], static_cast<std::uint32_t>(100 + number));
  EXPECT_EQ(batch.barycentrics[i], (neural::Float2{0.01f * f, 0.02f * f}));
  EXPECT_EQ(batch.positions[i], (neural::Float3{f, f + 0.25f, f + 0.5f}));
  EXPECT_EQ(batch.directions[i], (neural::Float3{1.0f, 0.0f, f}));
  EXPECT_EQ(batch.normals[i], (neural::Float3{0.0f, f, 1.0f}));
  EXPECT_EQ(batch.albedos[i], (neural::Float3{0.3f * f, 0.2f * f, 0.1f * f}));
  EXPECT_EQ(batch.roughnesses[i], 0.1f * f);
}

TEST(SurfacePoints, UnusedInputsAreNotStored) {
  const auto sizes = [](const PointInputs& inputs) {
    SurfacePoints points(inputs);
    for (int i = 0; i < 3; ++i) push(points, i);
    points.resize(4);
    const neural::QueryBatch b = points.batch();
    EXPECT_EQ(b.size, 4u);
    EXPECT_EQ(b.surfaces.size(), 4u);
    EXPECT_EQ(b.triangles.size(), 4u);
    EXPECT_EQ(b.barycentrics.size(), 4u);
    return std::array{b.positions.size(), b.directions.size(), b.normals.size(), b.albedos.size(),
                      b.roughnesses.size()};
  };
  PointInputs inputs;
  using Sizes = std::array<std::size_t, 5>;
  EXPECT_EQ(sizes(inputs), (Sizes{0, 0, 0, 0, 0}));
  inputs.directions = true;
  EXPECT_EQ(sizes(inputs), (Sizes{0, 4, 0, 0, 0}));
  inputs.positions = inputs.roughnesses = true;
  EXPECT_EQ(sizes(inputs), (Sizes{4, 4, 0, 0, 4}));
  EXPECT_EQ(sizes(everything()), (Sizes{4, 4, 4, 4, 4}));
}

TEST(SurfacePoints, TheInputsFollowFromTheModel) {
  neural::ModelConfig config;
  EXPECT_EQ(PointInputs(config), PointInputs());
  config.auxiliary = {{neural::InputSource::direction}, {neural::InputSource::roughness}};
  PointInputs expected;
  expected.directions = expected.roughnesses = true;
  EXPECT_EQ(PointInputs(config), expected);
  config.encoding = neural::FeatureEncoding::hash_grid;
  config.auxiliary = {{neural::InputSource::normal}, {neural::InputSource::albedo}};
  expected = PointInputs();
  expected.positions = expected.normals = expected.albedos = true;
  EXPECT_EQ(PointInputs(config), expected);
}

TEST(SurfacePoints, RangesAreCopiedToTheirDestinations) {
  SurfacePoints from(everything());
  for (int i = 0; i < 6; ++i) push(from, i);
  SurfacePoints to(everything());
  to.resize(5);
  to.copy(from, 3, 3, 0);
  to.copy(from, 1, 2, 3);
  to.copy(from, 6, 0, 5);
  const neural::QueryBatch batch = to.batch();
  const int expected[] = {3, 4, 5, 1, 2};
  for (std::size_t i = 0; i < 5; ++i) expect_point(batch, i, expected[i]);
}

}  // namespace
}  // namespace gatelight::renderer
