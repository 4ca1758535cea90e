#include "scene/tangents.h"

#include <gtest/gtest.h>

#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

/// Returns a unit quad in the plane z = 0 that faces +z. `uv` is for its corners (0,0) (1,0) (1,1) (0,1).
Mesh quad(const std::vector<Vec2>& uv) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, Vec3::UnitZ());
  mesh.uv0 = uv;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TextureSlot slot() {
  TextureSlot s;
  s.texture = 0;
  return s;
}

void expect_frame(const Mesh& mesh, std::size_t vertex, const Vec3& tangent, const Vec3& bitangent) {
  const Vec3 t = mesh.tangents.at(vertex).head<3>();
  const Vec3 n = mesh.normals.empty() ? Vec3(Vec3::UnitZ()) : mesh.normals[vertex];
  EXPECT_TRUE(t.isApprox(tangent, 1e-5f)) << t.transpose();
  EXPECT_TRUE(Vec3(n.cross(t) * mesh.tangents[vertex].w()).isApprox(bitangent, 1e-5f));
}

TEST(Tangents, FollowUAndTheUpDirectionOfThePicture) {
  Mesh mesh = quad({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  Mesh mirrored = quad({{1, 1}, {0, 1}, {0, 0}, {1, 0}});
  generate_tangents(mesh, slot());
  generate_tangents(mirrored, slot());
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    expect_frame(mesh, i, Vec3::UnitX(), Vec3::UnitY());
    EXPECT_EQ(mesh.tangents[i].w(), 1.0f);
    expect_frame(mirrored, i, -Vec3::UnitX(), Vec3::UnitY());
    EXPECT_EQ(mirrored.tangents[i].w(), -1.0f);
  }
}

TEST(Tangents, TheTextureTransformTurnsTheFrame) {
  Mesh mesh = quad({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  TextureSlot turned = slot();
  turned.transform << 0, 1, 0, -1, 0, 0;  // a quarter turn: u grows downwards on the quad
  generate_tangents(mesh, turned);
  expect_frame(mesh, 0, -Vec3::UnitY(), Vec3::UnitX());
}

TEST(Tangents, FlatMeshesGetAFrameForEachTriangle) {
  Mesh mesh = quad({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  mesh.normals.clear();
  mesh.positions[3].z() = 5.0f;
  generate_tangents(mesh, slot());
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.triangles[1][2], 5u);
  EXPECT_EQ(mesh.positions[5], Vec3(0, 1, 5));
  for (const Vec4& t : mesh.tangents) EXPECT_NEAR(t.head<3>().norm(), 1.0f, 1e-5f);
}

TEST(Tangents, WithoutAGradientOfCoordinatesTheyLieInTheTriangle) {
  Mesh degenerate = quad(std::vector<Vec2>(4, Vec2(0.5f, 0.5f)));
  Mesh ramp = degenerate;
  degenerate.positions[2] = degenerate.positions[1];
  ramp.normals.clear();
  for (Vec3& p : ramp.positions) p.z() = -p.x();
  for (auto& [mesh, normal] : {std::pair(&degenerate, Vec3(0, 0, 1)), std::pair(&ramp, Vec3(1, 0, 1))}) {
    generate_tangents(*mesh, slot());
    for (const Vec4& t : mesh->tangents) {
      EXPECT_NEAR(t.head<3>().norm(), 1.0f, 1e-5f);
      EXPECT_NEAR(t.head<3>().dot(normal), 0.0f, 1e-5f);
    }
  }
}

GltfBuilder with_normal_map() {
  GltfBuilder file = triangle_of({{"normalTexture", {{"index", 0}}}});
  file.add("images", {{"uri", "absent.png"}});
  file.add("textures", {{"source", 0}});
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
  attributes["TANGENT"] =
      file.accessor(std::vector<float>{0, 2, 0, -1, 0, 2, 0, -1, 0, 0, 0, 0}, kFloat, "VEC4", 3);
  return file;
}

TEST(Tangents, TangentsOfTheFileAreUsedWhenANormalMapNeedsThem) {
  GltfBuilder file = with_normal_map();
  const LoadOptions options{.missing_is_error = false};
  const Mesh own = only_mesh(file.load(options));
  EXPECT_TRUE(own.tangents.at(0).isApprox(Vec4(0, 1, 0, -1)));
  EXPECT_NEAR(own.tangents.at(2).head<3>().norm(), 1.0f, 1e-5f) << "repaired";
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
  EXPECT_TRUE(only_mesh(file.load(options)).tangents.at(0).isApprox(Vec4(1, 0, 0, 1))) << "generated";
  file.root["materials"][0] = json::object();
  EXPECT_TRUE(only_mesh(file.load(options)).tangents.empty()) << "unused";
}

TEST(Tangents, AllThatNeedsAFrameGetsTheSame) {
  GltfBuilder file = with_normal_map();
  file.root["meshes"][0]["primitives"][0]["attributes"].erase("TANGENT");
  const LoadOptions options{.missing_is_error = false};
  const std::vector<Vec4> expected = only_mesh(file.load(options)).tangents;
  file.root["materials"][0] = {{"extensions", {{"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}}}}}};
  EXPECT_EQ(only_mesh(file.load(options)).tangents, expected);
  file.root["materials"][0] = {{"extensions",
                                {{"KHR_materials_clearcoat",
                                  {{"clearcoatFactor", 1.0}, {"clearcoatNormalTexture", {{"index", 0}}}}}}}};
  EXPECT_EQ(only_mesh(file.load(options)).tangents, expected);
}

}  // namespace
}  // namespace gatelight::scene
