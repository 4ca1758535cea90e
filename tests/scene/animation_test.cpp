// Scenes at a time of their animations, against the formulas of the glTF specification.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;
using Floats = std::vector<float>;

constexpr float kTurn = 6.2831853f;

/// x, y, z, w.
Floats about(const Vec3& axis, float angle) {
  const Vec3 v = std::sin(angle / 2.0f) * axis.normalized();
  return {v.x(), v.y(), v.z(), std::cos(angle / 2.0f)};
}

Floats joined(std::initializer_list<Floats> rows) {
  Floats all;
  for (const Floats& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

void expect_rotation(AnimatedFile file, double time, const Vec3& axis, float angle) {
  const Eigen::Matrix3f expected = Eigen::AngleAxisf(angle, axis.normalized()).toRotationMatrix();
  const Eigen::Matrix3f found = file.transform_at(time).linear();
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 2e-6f) << "at " << time << "\n" << found;
}

TEST(Animations, WithoutATimeNothingMoves) {
  AnimatedFile file = moving_triangle({{"translation", {1, 2, 3}}});
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({5, 5, 5, 6, 6, 6})});
  const Scene scene = file.load({.bake_transforms = false});
  EXPECT_EQ(Vec3(scene.instances[0].transform.translation()), Vec3(1, 2, 3));
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.animations.size(), 1u);
  EXPECT_EQ(scene.animations[0].name, "only");
  EXPECT_EQ(scene.animations[0].seconds, 1.0);
}

TEST(Animations, LinearKeysJoinByStraightLines) {
  AnimatedFile file = translated_triangle({1, 3, 4}, {0, 0, 0, 8, -4, 2, 8, 0, 0});
  EXPECT_EQ(file.place_at(1.0), Vec3(0, 0, 0));
  EXPECT_EQ(file.place_at(1.5), Vec3(2, -1, 0.5f));
  EXPECT_EQ(file.place_at(3.0), Vec3(8, -4, 2));
  EXPECT_EQ(file.place_at(3.75), Vec3(8, -1, 0.5f));
}

TEST(Animations, TimesOutsideTheKeysGiveTheNearestKey) {
  for (const char* interpolation : {"STEP", "LINEAR"}) {
    AnimatedFile file = translated_triangle({1, 2}, {1, 0, 0, 2, 0, 0}, interpolation);
    for (const double before : {-1e9, 0.0, 0.999}) EXPECT_EQ(file.place_at(before), Vec3(1, 0, 0));
    for (const double after : {2.0, 2.001, 1e9}) EXPECT_EQ(file.place_at(after), Vec3(2, 0, 0));
  }
}

TEST(Animations, OneKeyHoldsAlways) {
  for (const char* interpolation : {"STEP", "LINEAR"}) {
    AnimatedFile file = translated_triangle({2}, {1, 2, 3}, interpolation);
    for (const double time : {0.0, 2.0, 5.0}) EXPECT_EQ(file.place_at(time), Vec3(1, 2, 3));
  }
  AnimatedFile spline = translated_triangle({2}, {9, 9, 9, 1, 2, 3, 9, 9, 9}, "CUBICSPLINE");
  for (const double time : {0.0, 2.0, 5.0}) EXPECT_EQ(spline.place_at(time), Vec3(1, 2, 3));
}

TEST(Animations, StepsChangeExactlyAtTheirKeys) {
  // 0.1 has no exact number in single precision.
  AnimatedFile file = translated_triangle({0, 0.1f, 0.7f}, {1, 0, 0, 2, 0, 0, 3, 0, 0}, "STEP");
  EXPECT_EQ(file.place_at(0.0999), Vec3(1, 0, 0));
  EXPECT_EQ(file.place_at(0.1), Vec3(2, 0, 0));
  EXPECT_EQ(file.place_at(0.6999), Vec3(2, 0, 0));
  EXPECT_EQ(file.place_at(0.7), Vec3(3, 0, 0));
}

TEST(Animations, CubicSplinesAreThePolynomialsOfHermite) {
  // In-tangent, value and out-tangent of each key.
  AnimatedFile file = translated_triangle(
      {1, 3}, {7, 7, 7, 1, 0, -2, 0.5f, 3, 0, -1, 0, 4, 5, 1, -2, 7, 7, 7}, "CUBICSPLINE");
  for (const double u : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const double h00 = (1 + 2 * u) * (1 - u) * (1 - u);
    const double h10 = u * (1 - u) * (1 - u);
    const double h01 = u * u * (3 - 2 * u);
    const double h11 = u * u * (u - 1);
    const double length = 2.0;
    const Eigen::Vector3d expected =
        h00 * Eigen::Vector3d(1, 0, -2) + length * h10 * Eigen::Vector3d(0.5, 3, 0) +
        h01 * Eigen::Vector3d(5, 1, -2) + length * h11 * Eigen::Vector3d(-1, 0, 4);
    EXPECT_LT((file.place_at(1.0 + length * u) - expected.cast<float>()).norm(), 2e-6f) << u;
  }
}

TEST(Animations, RotationsTurnAtAConstantRate) {
  const Vec3 axis(1, -2, 0.5f);
  AnimatedFile file = rotated_triangle({0, 2}, joined({about(axis, 0.3f), about(axis, 2.8f)}));
  for (const double time : {0.0, 0.1, 0.5, 1.0, 1.7, 2.0})
    expect_rotation(file, time, axis, 0.3f + 1.25f * static_cast<float>(time));
}

TEST(Animations, RotationsTakeTheShorterWay) {
  const Vec3 axis(0, 1, 0);
  Floats to = about(axis, 0.4f * kTurn);
  for (float& v : to) v = -v;  // the same rotation
  AnimatedFile file = rotated_triangle({0, 1}, joined({about(axis, 0.0f), to}));
  expect_rotation(file, 0.5, axis, 0.2f * kTurn);
  AnimatedFile far = rotated_triangle({0, 1}, joined({about(axis, 0.0f), about(axis, 0.8f * kTurn)}));
  expect_rotation(far, 0.5, axis, -0.1f * kTurn);
}

TEST(Animations, EqualAndNearlyEqualRotationsStayUnit) {
  const Vec3 axis(0, 0, 1);
  AnimatedFile file =
      rotated_triangle({0, 1, 2}, joined({about(axis, 1.0f), about(axis, 1.0f), about(axis, 1.0f + 1e-6f)}));
  for (const double time : {0.5, 1.5}) expect_rotation(file, time, axis, 1.0f);
}

TEST(Animations, SplinesOfRotationsAreNormalised) {
  const Vec3 axis(0, 0, 1);
  const Floats none{0, 0, 0, 0};
  AnimatedFile file = rotated_triangle(
      {0, 1}, joined({none, about(axis, 0.0f), none, none, about(axis, kTurn / 4.0f), none}), "CUBICSPLINE");
  // Halfway, flat tangents give the mean of both keys, whose length is not 1.
  expect_rotation(file, 0.5, axis, kTurn / 8.0f);
  const double h = 0.25 * 0.25 * (3.0 - 2.0 * 0.25);
  const double s = h * std::sqrt(0.5);
  expect_rotation(file, 0.25, axis, static_cast<float>(2.0 * std::atan2(s, 1.0 - h + s)));
}

TEST(Animations, ARotationOfZerosIsNone) {
  AnimatedFile file = rotated_triangle({0, 1}, joined({{0, 0, 0, 0}, about({1, 0, 0}, 1.0f)}));
  expect_rotation(file, 0.0, {1, 0, 0}, 0.0f);
  expect_rotation(file, 0.5, {1, 0, 0}, 0.5f);
}

TEST(Animations, OneNodeHasSeveralChannels) {
  AnimatedFile file = moving_triangle({{"translation", {9, 9, 9}}, {"scale", {5, 5, 5}}});
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 2, 4, 6})});
  file.move(0, "scale", {file.seconds({0, 2}), file.vectors({1, 1, 1, 3, 5, 1})}, "LINEAR");
  const Affine t = file.transform_at(0.5);
  EXPECT_EQ(Vec3(t.translation()), Vec3(1, 2, 3));
  EXPECT_TRUE(t.linear().isApprox(Vec3(1.5f, 2, 1).asDiagonal().toDenseMatrix()));
}

TEST(Animations, ValuesThatDoNotMoveStay) {
  AnimatedFile file = moving_triangle({{"translation", {1, 2, 3}}});
  file.move(0, "scale", {file.seconds({0}), file.vectors({2, 2, 2})});
  EXPECT_EQ(file.place_at(0.0), Vec3(1, 2, 3));
}

TEST(Animations, ChildrenFollow) {
  AnimatedFile file;
  const int child = file.add("nodes", {{"mesh", file.mesh(file.triangle())}, {"translation", {1, 0, 0}}});
  const int parent = file.node({{"children", {child}}});
  file.move(parent, "rotation",
            {file.seconds({0, 1}),
             file.quaternions(joined({about({0, 0, 1}, 0.0f), about({0, 0, 1}, kTurn / 4.0f)}))});
  EXPECT_TRUE(file.place_at(1.0).isApprox(Vec3(0, 1, 0), 1e-6f));
}

TEST(Animations, NormalisedIntegersAreNumbersUpToOne) {
  const float s = std::sqrt(0.5f);
  AnimatedFile bytes = moving_triangle();
  bytes.move(0, "rotation",
             {bytes.seconds({0, 1}), bytes.accessor(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 90, 90},
                                                    kByte, "VEC4", 2, {{"normalized", true}})});
  expect_rotation(bytes, 1.0, {0, 0, 1}, kTurn / 4.0f);
  AnimatedFile shorts = moving_triangle();
  const auto half = static_cast<std::int16_t>(std::lround(32767.0f * s));
  shorts.move(
      0, "rotation",
      {shorts.seconds({0, 1}), shorts.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, half, 0, 0, half},
                                               kShort, "VEC4", 2, {{"normalized", true}})});
  expect_rotation(shorts, 1.0, {1, 0, 0}, kTurn / 4.0f);
  expect_rotation(shorts, 0.5, {1, 0, 0}, kTurn / 8.0f);
}

Vec3 first_vertex(AnimatedFile& file, double time) {
  return only_mesh(file.at(time)).positions[0];
}

TEST(Animations, WeightsOfMorphTargetsMoveTogether) {
  AnimatedFile file = morphing_triangle();
  file.move(0, "weights", {file.seconds({0, 1}), file.scalars({0, 1, 1, 0.5f})});
  EXPECT_EQ(first_vertex(file, 0.0), Vec3(0, 1, 0));
  EXPECT_EQ(first_vertex(file, 0.5), Vec3(0.5f, 0.75f, 0));
  EXPECT_EQ(first_vertex(file, 1.0), Vec3(1, 0.5f, 0));
}

TEST(Animations, SplinesOfWeightsHaveAllInTangentsThenAllValues) {
  AnimatedFile file = morphing_triangle();
  file.move(0, "weights", {file.seconds({0, 1}), file.scalars({9, 9, 0, 1, 0, 0, 0, 0, 1, 0.5f, 9, 9})},
            "CUBICSPLINE");
  EXPECT_EQ(first_vertex(file, 0.0), Vec3(0, 1, 0));
  EXPECT_EQ(first_vertex(file, 0.5), Vec3(0.5f, 0.75f, 0));
}

TEST(Animations, SkinsFollowTheirJoints) {
  AnimatedFile file;
  const int mesh = file.mesh(triangle_of_joint(file));
  const int joint = file.node(json::object());
  file.add("skins", {{"joints", {joint}}});
  file.node({{"mesh", mesh}, {"skin", 0}});
  file.move(joint, "translation", {file.seconds({0, 2}), file.vectors({0, 0, 0, 0, 0, 4})});
  EXPECT_EQ(first_vertex(file, 0.5), Vec3(0, 0, 1));
  EXPECT_EQ(first_vertex(file, 2.0), Vec3(0, 0, 4));
}

TEST(Animations, CamerasAndLightsFollowTheirNodes) {
  AnimatedFile file = moving_triangle();
  set_lights(file, {{{"type", "point"}}});
  const int node = file.node({{"camera", camera(file)}, {"extensions", light_of_node(0)}});
  file.move(node, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 0, 2, 0})});
  const Scene scene = file.at(0.5);
  EXPECT_EQ(Vec3(scene.cameras[0].transform.translation()), Vec3(0, 1, 0));
  EXPECT_EQ(scene.lights[0].position, Vec3(0, 1, 0));
}

TEST(Animations, AMatrixIsTakenApart) {
  AnimatedFile file = moving_triangle({{"matrix", {0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1}}});
  const Eigen::Matrix3f still =
      AnimatedFile(file).load({.bake_transforms = false}).instances[0].transform.linear();
  file.move(0, "translation", {file.seconds({0}), file.vectors({1, 1, 1})});
  const Scene scene = file.at(0.0);
  EXPECT_EQ(Vec3(scene.instances[0].transform.translation()), Vec3(1, 1, 1));
  EXPECT_LT((scene.instances[0].transform.linear() - still).cwiseAbs().maxCoeff(), 1e-6f);
  expect_messages(scene.warnings, {{"matrix"}});
}

}  // namespace
}  // namespace gatelight::scene
