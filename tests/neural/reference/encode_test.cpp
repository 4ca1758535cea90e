#include "neural/reference/encode.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "neural/reference/auxiliary.h"
#include "neural/reference/hash_grid_encoding.h"
#include "neural/reference/one_blob.h"
#include "tests/support/model_batches.h"
#include "tests/support/model_cases.h"

namespace gatelight::neural::reference {
namespace {

using testing::find_model_case;

std::vector<double> auxiliary(const AuxiliaryInput& input, const Point& point) {
  std::vector<double> inputs;
  append_auxiliary(input, point, inputs);
  EXPECT_EQ(inputs.size(), input_count(input));
  return inputs;
}

TEST(Encode, SphericalCoordinatesArePolarThenAzimuth) {
  const auto expect = [](std::array<double, 3> direction, double theta, double phi) {
    EXPECT_NEAR(spherical(direction)[0], theta, 1e-15);
    EXPECT_NEAR(spherical(direction)[1], phi, 1e-15);
  };
  expect({0, 0, 1}, 0, 0);
  expect({0, 0, -1}, 1, 0);
  expect({1, 0, 0}, 0.5, 0);
  expect({0, 1, 0}, 0.5, 0.25);
  expect({-1, 0, 0}, 0.5, 0.5);
  expect({0, -1, 0}, 0.5, -0.25);
  expect({0, 0, 1.0000001}, 0, 0);  // a unit vector up to rounding
}

TEST(Encode, AzimuthWrapsAndPolarAngleDoesNot) {
  const AuxiliaryInput input{InputSource::direction, InputEncoding::one_blob, 8};
  Point left, right, up, down;
  left.direction = {-1, 1e-9, 0};
  right.direction = {-1, -1e-9, 0};
  up.direction = {0, 0, 1};
  down.direction = {0, 0, -1};
  const std::vector<double> a = auxiliary(input, left), b = auxiliary(input, right);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-7);
  const std::vector<double> above = auxiliary(input, up), below = auxiliary(input, down);
  EXPECT_NEAR(above[0], 0.5, 1e-15);
  EXPECT_EQ(above[7], 0.0);
  EXPECT_EQ(below[0], 0.0);
  EXPECT_NEAR(below[7], 0.5, 1e-15);
}

TEST(Encode, OnlyDirectionsWrap) {
  // The second coordinate of positions and albedos is not an angle.
  Point low;
  low.position = low.albedo = {0.5, 0, 0.5};
  for (const InputSource source : {InputSource::position, InputSource::albedo}) {
    const std::vector<double> inputs = auxiliary({source, InputEncoding::one_blob, 4}, low);
    EXPECT_NEAR(inputs[4], 0.5, 1e-15);
    EXPECT_EQ(inputs[7], 0.0);
  }
}

TEST(Encode, FeatureLevelsComeFirstThenAuxiliaryInputsInTheirOrder) {
  const auto model_case = find_model_case("hash_with_everything");
  const Model& model = *model_case.model;
  const testing::OwnedBatch batch = testing::make_batch(model, 1, 1);
  const Point point = read_point(model, batch.points(), 0);
  std::vector<double> parameters(model.parameters.count);
  for (std::size_t p = 0; p < parameters.size(); ++p) parameters[p] = std::sin(static_cast<double>(p));
  const std::vector<double> inputs = encode(model, parameters, point);
  ASSERT_EQ(inputs.size(), model.parameters.inputs);

  const std::vector<NodeWeight> nodes = encoding_nodes(model, point);
  ASSERT_EQ(nodes.size(), model.nodes_per_point());
  for (std::size_t level = 0; level < model.levels(); ++level)
    for (std::size_t l = 0; l < 4; ++l) {
      double expected = 0;
      for (std::size_t t = 8 * level; t < 8 * level + 8; ++t)
        expected += nodes[t].weight * parameters[nodes[t].node * 4 + l];
      EXPECT_NEAR(inputs[level * 4 + l], expected, 1e-14);
    }
  std::vector<double> rest;
  for (const AuxiliaryInput& input : model.config.auxiliary) append_auxiliary(input, point, rest);
  EXPECT_TRUE(
      std::equal(rest.begin(), rest.end(), inputs.begin() + model.parameters.feature_inputs, inputs.end()));
}

TEST(Encode, PositionsAreMappedToTheUnitCubeAndClamped) {
  ModelConfig config = testing::default_plain_config();
  config.hash_grid.bounds_min = {-1, 0, 0};
  config.hash_grid.bounds_max = {3, 1, 2};
  const auto model = make_model(config);
  const std::vector<Float3> positions = {{1, 1, 2}, {-9, 9, std::nanf("")}};
  QueryBatch batch;
  batch.positions = positions;
  batch.size = 2;
  EXPECT_EQ(read_point(*model, batch, 0).position, (std::array<double, 3>{0.5, 0.25, 0.5}));
  EXPECT_EQ(read_point(*model, batch, 1).position, (std::array<double, 3>{0, 1, 0}));
}

TEST(Encode, EqualFeaturesOfALevelAreInterpolatedExactly) {
  // Partition of unity for every encoding: all nodes 1 gives features of 1.
  for (const auto& [name, config] : testing::all_model_configs()) {
    const auto model_case = testing::make_case(name, config);
    const Model& model = *model_case.model;
    const testing::OwnedBatch batch = testing::make_batch(model, 20, 6, {.border = 0.3f});
    const std::vector<double> parameters(model.parameters.count, 1.0);
    for (std::size_t r = 0; r < batch.size(); ++r) {
      const std::vector<double> inputs = encode(model, parameters, read_point(model, batch.points(), r));
      for (std::size_t i = 0; i < model.parameters.feature_inputs; ++i)
        ASSERT_NEAR(inputs[i], 1.0, 1e-12) << name;
    }
  }
}

HashGridLayout hash_layout(std::uint32_t base, float growth, std::uint32_t levels, std::uint32_t log2_table) {
  const HashGridOptions options{
      .levels = levels, .base_resolution = base, .growth = growth, .log2_table_size = log2_table};
  return build_hash_grid_layout(options);
}

TEST(HashGridEncoding, PointsLieHalfACellFromTheLattice) {
  // Base 3: x scale + 0.5 = 2x + 0.5. (0, 0.5, 0.875) lies at (0.5, 1.5, 2.25).
  const HashGridLayout layout = hash_layout(3, 1.0f, 1, 10);
  const std::vector<NodeWeight> nodes = hash_grid_nodes(layout, {0, 0.5, 0.875});
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const std::uint32_t x = corner % 2, y = 1 + corner / 2 % 2, z = 2 + corner / 4;
    EXPECT_EQ(nodes[corner].node, (x + 3 * y + 9 * z) % 32);
    EXPECT_DOUBLE_EQ(nodes[corner].weight, 0.5 * 0.5 * (z == 2 ? 0.75 : 0.25));
  }
}

TEST(HashGridEncoding, DenseEntriesAreDistinctAndWrapOnlyBeyondTheBorder) {
  const HashGridLevel level = hash_layout(6, 1.0f, 1, 10).levels[0];
  ASSERT_EQ(level.dense, 1u);
  std::vector<bool> seen(level.entries, false);
  for (std::uint32_t z = 0; z < 6; ++z)
    for (std::uint32_t y = 0; y < 6; ++y)
      for (std::uint32_t x = 0; x < 6; ++x) {
        const std::uint32_t entry = hash_grid_entry(level, x, y, z);
        EXPECT_FALSE(seen[entry]);
        seen[entry] = true;
      }
  EXPECT_EQ(hash_grid_entry(level, 6, 0, 0), hash_grid_entry(level, 0, 1, 0));
  EXPECT_EQ(hash_grid_entry(level, 6, 6, 6), (6 + 36 + 216) % level.entries);
}

TEST(HashGridEncoding, HashedEntriesFollowThePrimes) {
  HashGridLevel level;
  level.resolution = 1000;
  level.entries = 1000;
  EXPECT_EQ(hash_grid_entry(level, 5, 0, 0), 5u);
  EXPECT_EQ(hash_grid_entry(level, 0, 1, 0), 2654435761u % 1000);
  EXPECT_EQ(hash_grid_entry(level, 0, 0, 1), 805459861u % 1000);
  // 3 ^ (2 x 2654435761 mod 2^32) ^ (4 x 805459861 mod 2^32) = 3 ^ 1013904226 ^ 3221839444
  EXPECT_EQ(hash_grid_entry(level, 3, 2, 4), (3u ^ 1013904226u ^ 3221839444u) % 1000);
}

}  // namespace
}  // namespace gatelight::neural::reference
