// The rules of MikkTSpace: which corners share a tangent, and how it is weighted. topology_test.cpp tests the
// frame of a single triangle.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "scene/tangents.h"

namespace gatelight::scene {
namespace {

Mesh generated(Mesh mesh) {
  generate_tangents(mesh, TextureSlot{.texture = 0});
  return mesh;
}

Vec4 corner_tangent(const Mesh& mesh, std::size_t corner) {
  return mesh.tangents.at(mesh.triangles.at(corner / 3)[corner % 3]);
}

/// Adds a vertex whose picture has u and -v at `picture`.
void add_vertex(Mesh& mesh, const Vec3& position, const Vec2& picture, const Vec3& normal = Vec3::UnitZ()) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uv0.emplace_back(picture.x(), -picture.y());
}

/// Nine vertices at uneven places, whose picture is mirrored at the middle column.
Mesh bumpy() {
  Mesh mesh;
  for (int i = 0; i < 9; ++i) {
    const int x = i % 3, y = i / 3;
    const auto real = [](int a) { return static_cast<float>(a); };
    mesh.positions.emplace_back(real(x) + 0.125f * real(5 * i % 3), real(y) + 0.125f * real(7 * i % 4),
                                0.25f * real(3 * i * i % 5));
    mesh.normals.push_back(
        Vec3(0.25f * real(2 * i % 3) - 0.25f, 0.25f * real(i * i % 3) - 0.25f, 1.0f).normalized());
    mesh.uv0.emplace_back(std::abs(0.5f * real(x) - 0.5f) + (x == 1 ? 0.0f : 0.0625f * real(i % 4)),
                          -0.5f * real(y) + 0.0625f * real(3 * i % 5));
  }
  for (const std::uint32_t i : {0u, 1u, 3u, 4u}) {
    mesh.triangles.push_back({i, i + 1, i + 4});
    mesh.triangles.push_back({i, i + 4, i + 3});
  }
  return mesh;
}

/// The same triangles with three vertices each.
Mesh unshared(const Mesh& mesh) {
  Mesh result;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t i : t) {
      result.positions.push_back(mesh.positions[i]);
      result.normals.push_back(mesh.normals[i]);
      result.uv0.push_back(mesh.uv0[i]);
    }
    const auto end = static_cast<std::uint32_t>(result.positions.size());
    result.triangles.push_back({end - 3, end - 2, end - 1});
  }
  return result;
}

TEST(MikkTSpace, EqualsThePublishedImplementation) {
  // Results of mikktspace.c for bumpy(), with v turned up and the sign negated as glTF demands.
  const std::map<std::uint32_t, Vec3> mirrored = {
      {0, {-0.94937f, 0.26318f, -0.17155f}}, {1, {-0.84432f, -0.49252f, 0.21108f}},
      {3, {-0.89886f, 0.42169f, -0.11929f}}, {4, {-0.95531f, 0.17422f, 0.23883f}},
      {6, {-0.90981f, 0.39452f, -0.12882f}}, {7, {-0.92644f, 0.29676f, 0.23161f}}};
  const std::map<std::uint32_t, Vec3> plain = {
      {1, {0.96444f, -0.10827f, -0.24111f}}, {2, {0.91915f, -0.39392f, 0.00000f}},
      {4, {0.94860f, 0.20954f, -0.23715f}},  {5, {0.99996f, -0.00846f, 0.00000f}},
      {7, {0.93233f, 0.27645f, -0.23308f}},  {8, {0.98172f, 0.19031f, 0.00000f}}};
  const Mesh before = bumpy();
  const Mesh mesh = generated(before);
  EXPECT_EQ(mesh.positions.size(), 12u);
  for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
    const std::uint32_t v = before.triangles[c / 3][c % 3];
    const bool is_mirrored = c < 6 || (c >= 12 && c < 18);
    const Vec4 tangent = corner_tangent(mesh, c);
    EXPECT_EQ(tangent.w(), is_mirrored ? -1.0f : 1.0f);
    EXPECT_TRUE(tangent.head<3>().isApprox(is_mirrored ? mirrored.at(v) : plain.at(v), 2e-5f)) << c;
  }
}

TEST(MikkTSpace, CornersWeighByTheirAngleSeenAlongTheNormal) {
  // Corners of 90 and 45 degrees, whose tangents are (1, 0) and (1, 1) / sqrt(2). Heights change neither.
  for (const float height : {0.0f, 3.0f}) {
    Mesh mesh;
    add_vertex(mesh, {0, 0, 0}, {0, 0});
    add_vertex(mesh, {1, 0, height}, {1, 0});
    add_vertex(mesh, {0, 1, -2 * height}, {0, 1});
    add_vertex(mesh, {-1, 1, height}, {-1, 2});
    mesh.triangles = {{0, 1, 2}, {2, 3, 0}};
    mesh = generated(mesh);
    const Vec3 expected(2.0f + std::sqrt(0.5f), std::sqrt(0.5f), 0.0f);
    EXPECT_TRUE(corner_tangent(mesh, 0).head<3>().isApprox(expected.normalized(), 1e-5f)) << height;
    EXPECT_EQ(mesh.positions.size(), 4u);
  }
}

/// Returns a unit sphere of 2 `n` by `n` quads.
Mesh sphere(std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= 2 * n; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(2 * n);
      const float v = static_cast<float>(y) / static_cast<float>(n);
      const float phi = 2 * kPi * u, theta = kPi * v;
      const Vec3 p(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta));
      add_vertex(mesh, p, {u, v}, p);
    }
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < 2 * n; ++x) {
      const std::uint32_t i = y * (2 * n + 1) + x;
      mesh.triangles.push_back({i, i + 1, i + 2 * n + 2});
      mesh.triangles.push_back({i, i + 2 * n + 2, i + 2 * n + 1});
    }
  }
  return mesh;
}

/// The largest angle between the tangents and dP/du at 45 degrees of latitude or less.
float sphere_error(std::uint32_t n) {
  const Mesh mesh = generated(sphere(n));
  float error = 0.0f;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3& p = mesh.positions[i];
    if (std::abs(p.z()) > 0.71f) continue;
    const Vec3 along_u = Vec3(-p.y(), p.x(), 0.0f).normalized();
    const Vec3 tangent = mesh.tangents[i].head<3>();
    error = std::max(error, std::atan2(along_u.cross(tangent).norm(), along_u.dot(tangent)));
    EXPECT_EQ(mesh.tangents[i].w(), 1.0f);
  }
  return error;
}

TEST(MikkTSpace, TheTangentsOfASphereApproachItsDerivative) {
  const float coarse = sphere_error(16), fine = sphere_error(64);
  EXPECT_LT(coarse, 0.2f);
  EXPECT_LT(fine, 0.3f * coarse) << "of first order at the seam";
}

TEST(MikkTSpace, TheOrderOfTrianglesAndVerticesDoesNotMatter) {
  std::mt19937 random(5);
  Mesh mesh = bumpy();
  mesh.uv0[8] = mesh.uv0[5];  // a triangle without a gradient
  const Mesh expected = generated(mesh);
  for (int round = 0; round < 20; ++round) {
    std::vector<std::size_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random);
    std::vector<std::uint32_t> place(mesh.positions.size());
    std::iota(place.begin(), place.end(), 0u);
    std::shuffle(place.begin(), place.end(), random);
    Mesh moved = mesh;
    for (std::size_t i = 0; i < place.size(); ++i) {
      moved.positions[place[i]] = mesh.positions[i];
      moved.normals[place[i]] = mesh.normals[i];
      moved.uv0[place[i]] = mesh.uv0[i];
    }
    const std::uint32_t turn = random() % 3;
    for (std::size_t f = 0; f < order.size(); ++f) {
      for (std::uint32_t i = 0; i < 3; ++i)
        moved.triangles[f][i] = place[mesh.triangles[order[f]][(i + turn) % 3]];
    }
    moved = generated(moved);
    for (std::size_t c = 0; c < 3 * order.size(); ++c) {
      const std::size_t original = 3 * order[c / 3] + (c + turn) % 3;
      EXPECT_TRUE(corner_tangent(moved, c).isApprox(corner_tangent(expected, original), 1e-6f)) << c;
    }
  }
}

TEST(MikkTSpace, VerticesOfEqualAttributesAreOne) {
  const Mesh mesh = bumpy();
  const Mesh shared = generated(mesh);
  Mesh apart = unshared(mesh);
  for (Vec3& p : apart.positions) {
    if (&p - apart.positions.data() >= 12 && p.z() == 0.0f) p.z() = -0.0f;
  }
  apart = generated(apart);
  for (std::size_t c = 0; c < 3 * mesh.triangles.size(); ++c)
    EXPECT_EQ(corner_tangent(apart, c), corner_tangent(shared, c));
}

/// Two triangles on both sides of an edge, with tangents of 0 and 45 degrees.
Mesh hinge() {
  Mesh mesh;
  add_vertex(mesh, {0, 0, 0}, {0, 0});
  add_vertex(mesh, {1, 0, 0}, {1, 0});
  add_vertex(mesh, {0, 1, 0}, {0, 1});
  add_vertex(mesh, {-1, 1, 0}, {-1, 2});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(MikkTSpace, SeamsOfTheTextureAndOfNormalsEndAGroup) {
  for (const bool normals : {false, true}) {
    Mesh mesh = unshared(hinge());
    for (std::size_t i = 3; i < 6; ++i) {
      if (normals) mesh.normals[i] = Vec3(0.1f, 0.0f, 1.0f).normalized();
      if (!normals) mesh.uv0[i] += Vec2(2.0f, 0.0f);
    }
    mesh = generated(mesh);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_TRUE(corner_tangent(mesh, c).isApprox(Vec4(1, 0, 0, 1)));
    Vec3 other(1, 1, 0);
    other -= mesh.normals[3] * mesh.normals[3].dot(other);
    for (std::size_t c = 3; c < 6; ++c)
      EXPECT_TRUE(corner_tangent(mesh, c).head<3>().isApprox(other.normalized(), 1e-5f));
  }
}

/// A vertex and four around it. In the picture, the last two are turned by a right angle.
Mesh hub_and_four() {
  Mesh mesh;
  add_vertex(mesh, {0, 0, 0}, {0, 0});
  add_vertex(mesh, {1, 0, 0}, {1, 0});
  add_vertex(mesh, {0, 1, 0}, {0, 1});
  add_vertex(mesh, {-1, 0, 0}, {0, 1});
  add_vertex(mesh, {0, -1, 0}, {-1, 0});
  return mesh;
}

TEST(MikkTSpace, TrianglesThatShareOnlyAVertexAreTwoGroups) {
  Mesh mesh = hub_and_four();
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  mesh.uv1.assign(5, Vec2(0.25f, 0.5f));
  mesh.colors.assign(5, Vec4(1.0f, 0.5f, 0.25f, 1.0f));
  mesh = generated(mesh);
  EXPECT_TRUE(corner_tangent(mesh, 0).isApprox(Vec4(1, 0, 0, 1)));
  EXPECT_TRUE(corner_tangent(mesh, 3).isApprox(Vec4(0, 1, 0, 1)));
  ASSERT_EQ(mesh.positions.size(), 6u) << "split";
  EXPECT_EQ(mesh.positions[5], Vec3(0, 0, 0));
  EXPECT_EQ(mesh.normals.at(5), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.uv0.at(5), Vec2(0, 0));
  EXPECT_EQ(mesh.uv1.at(5), Vec2(0.25f, 0.5f));
  EXPECT_EQ(mesh.colors.at(5), Vec4(1.0f, 0.5f, 0.25f, 1.0f));
}

TEST(MikkTSpace, TrianglesWithoutAGradientBelongToTheGroupsOfTheirNeighbours) {
  // A fan of three triangles. The one in the middle has no area in the picture: it adds nothing to the sum,
  // and connects the others.
  Mesh mesh = hub_and_four();
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  const Mesh result = generated(mesh);
  EXPECT_EQ(result.positions.size(), 5u);
  EXPECT_TRUE(corner_tangent(result, 3).isApprox(Vec4(std::sqrt(0.5f), std::sqrt(0.5f), 0, 1), 1e-5f));
  EXPECT_TRUE(corner_tangent(result, 4).isApprox(Vec4(1, 0, 0, 1), 1e-5f));
  EXPECT_TRUE(corner_tangent(result, 5).isApprox(Vec4(0, 1, 0, 1), 1e-5f));
}

TEST(MikkTSpace, TrianglesWithoutAGradientTakeTheSideOfTheirNeighbours) {
  // A strip whose first triangle is mirrored; the others are points of the picture.
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    const auto x = static_cast<float>(i / 2), y = static_cast<float>(i % 2);
    add_vertex(mesh, {x, y, 0}, i < 2 ? Vec2(1 - x, y) : Vec2(0, 0));
  }
  for (std::uint32_t i = 0; i + 2 < 8; ++i)
    mesh.triangles.push_back(i % 2 == 0 ? std::array{i, i + 2, i + 1} : std::array{i, i + 1, i + 2});
  mesh = generated(mesh);
  EXPECT_EQ(mesh.positions.size(), 8u);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_EQ(corner_tangent(mesh, c).w(), -1.0f) << c;
  for (const Vec4& t : mesh.tangents) EXPECT_NEAR(t.head<3>().norm(), 1.0f, 1e-5f);
}

TEST(MikkTSpace, DegenerateTrianglesTakeOverAndChangeNothing) {
  const Mesh expected = generated(hinge());
  Mesh mesh = hinge();
  add_vertex(mesh, mesh.positions[2], {7, 5});
  mesh.triangles.push_back({0, 2, 4});  // no area, but a gradient
  mesh.triangles.push_back({3, 3, 3});
  mesh.triangles.push_back({1, 1, 0});
  mesh = generated(mesh);
  ASSERT_EQ(mesh.positions.size(), 5u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(mesh.tangents[i], expected.tangents[i]);
  EXPECT_NEAR(mesh.tangents[4].head<3>().norm(), 1.0f, 1e-5f);
}

TEST(MikkTSpace, TangentsThatCancelStillGiveAFrame) {
  Mesh mesh;  // a pole: the tangents point round it
  constexpr std::uint32_t kCount = 64;
  add_vertex(mesh, {0, 0, 0}, {0.5f, 1});
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const float u = static_cast<float>(i) / kCount;
    add_vertex(mesh, {std::cos(2 * kPi * u), std::sin(2 * kPi * u), 0}, {u, 0});
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCount});
  }
  mesh = generated(mesh);
  for (const Vec4& t : mesh.tangents) {
    EXPECT_NEAR(t.head<3>().norm(), 1.0f, 1e-5f);
    EXPECT_NEAR(t.z(), 0.0f, 1e-5f);
  }
}

/// Returns triangles around a vertex at the origin, with a planar picture.
Mesh fan(std::uint32_t count, bool connected) {
  Mesh mesh;
  add_vertex(mesh, {0, 0, 0}, {0, 0});
  const std::uint32_t rim = connected ? count : 2 * count;
  for (std::uint32_t i = 0; i < rim; ++i) {
    const double angle = 2.0 * 3.14159265358979 * i / rim;
    const Vec3 p(static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0f);
    add_vertex(mesh, p, p.head<2>() * (connected ? 1.0f : 1.0f + static_cast<float>(i % 7)));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = connected ? i : 2 * i;
    mesh.triangles.push_back({0, 1 + a, 1 + (a + 1) % rim});
  }
  return mesh;
}

TEST(MikkTSpace, ManyTrianglesAroundAVertexTakeLittleTime) {
  // Seconds instead of milliseconds, if the time grew with the square.
  constexpr std::uint32_t kCount = 100000;
  const Mesh connected = generated(fan(kCount, true));
  EXPECT_EQ(connected.positions.size(), kCount + 1);
  EXPECT_TRUE(connected.tangents[0].isApprox(Vec4(1, 0, 0, 1), 1e-4f));
  const Mesh apart = generated(fan(kCount, false));
  EXPECT_GT(apart.positions.size(), 2 * kCount + 1000) << "a group for each triangle";
  EXPECT_LE(apart.positions.size(), 3 * kCount);
}

}  // namespace
}  // namespace gatelight::scene
