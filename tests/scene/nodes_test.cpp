#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gltf_parts.h"
#include "tests/support/small_pngs.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;

TEST(Nodes, TrsEqualsItsMatrix) {
  const float s = std::sqrt(0.5f);
  GltfBuilder trs;
  trs.node({{"mesh", trs.mesh(trs.triangle())},
            {"translation", {1, 2, 3}},
            {"rotation", {0, 0, s, s}},
            {"scale", {2, 3, 4}}});
  GltfBuilder matrix;
  // A quarter turn about z after the scale, column by column.
  matrix.node({{"mesh", matrix.mesh(matrix.triangle())},
               {"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1}}});
  const Mesh a = only_mesh(trs.load());
  const Mesh b = only_mesh(matrix.load());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(a.positions[i].isApprox(b.positions[i], 1e-6f));
  EXPECT_TRUE(b.positions[1].isApprox(Vec3(1, 4, 3)));
  EXPECT_TRUE(b.positions[2].isApprox(Vec3(-2, 2, 3)));
}

TEST(Nodes, TransformsAccumulateFromTheRoot) {
  GltfBuilder file;
  const int mesh = file.mesh(file.triangle());
  file.add("nodes", {{"mesh", mesh}, {"translation", {1, 0, 0}}});
  file.add("nodes", {{"children", {0}}, {"scale", {2, 2, 2}}});
  file.node({{"children", {1}}, {"translation", {0, 0, 5}}});
  EXPECT_EQ(only_mesh(file.load()).positions[0], Vec3(2, 0, 5));
}

TEST(Nodes, RotationsNeedNotHaveUnitLength) {
  GltfBuilder file;
  file.node({{"mesh", file.mesh(file.triangle())}, {"rotation", {0, 0, 3, 3}}});
  EXPECT_TRUE(only_mesh(file.load()).positions[1].isApprox(Vec3(0, 1, 0)));
}

TEST(Nodes, AMeshInSeveralNodesIsSeveralInstances) {
  GltfBuilder file;
  const int mesh = file.mesh(file.triangle());
  file.node({{"mesh", mesh}, {"name", "left"}});
  file.node({{"mesh", mesh}, {"name", "right"}, {"translation", {4, 0, 0}}});
  const Scene scene = file.load({.bake_transforms = false});
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[1].name, "right");
  EXPECT_EQ(world_triangle(scene, scene.instances[1], 0)[0], Vec3(4, 0, 0));
  EXPECT_EQ(scene.bounds.max(), Vec3(5, 1, 0));
}

TEST(Nodes, AnInstanceHasTheNameOfItsNodeElseOfItsMeshElseANumber) {
  GltfBuilder file;
  const int plain = file.mesh(file.triangle());
  file.add("meshes", {{"primitives", {file.triangle()}}, {"name", "cup"}});
  file.node({{"mesh", plain}, {"name", "left"}});
  file.node({{"mesh", plain + 1}});
  file.node({{"mesh", plain}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[0].name, "left");
  EXPECT_EQ(scene.instances[1].name, "cup");
  EXPECT_EQ(scene.instances[2].name, "node 2");
}

TEST(Nodes, ADeepChainNeitherOverflowsNorLosesItsPlace) {
  GltfBuilder file;
  const int depth = 20000;
  const int mesh = file.mesh(file.triangle());
  json nodes = json::array();
  for (int i = 0; i + 1 < depth; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {0.5, 0, 0}}});
  nodes.push_back({{"mesh", mesh}});
  file.root["nodes"] = nodes;
  file.root["scenes"] = {{{"nodes", {0}}}};
  const Scene scene = file.load();
  // The scene is so far from the origin that the loader moves it to its centre.
  EXPECT_EQ(Vec3(only_mesh(scene).positions[0] + scene.origin), Vec3(0.5f * (depth - 1), 0, 0));
}

TEST(Nodes, CyclesTwoParentsAndOverflowAlongTheHierarchyAreRefused) {
  const auto refuse = [](const json& nodes, const json& roots, const tests::NameList& names) {
    GltfBuilder file;
    file.mesh(file.triangle());
    file.root["nodes"] = nodes;
    file.root["scenes"] = {{{"nodes", roots}}};
    file.expect_refused(names);
  };
  const json parent = {{"children", {0}}};
  refuse({{{"children", {1}}}, {{"children", {2}}}, parent}, json::array({0}), {"nodes[0]", "ancestor"});
  refuse({{{"mesh", 0}}, parent, parent}, {1, 2}, {"nodes[2].children", "node 0", "node 1"});
  const json huge = {1e30, 1, 1};
  refuse({{{"mesh", 0}, {"scale", huge}}, {{"children", {0}}, {"scale", huge}}}, json::array({1}),
         {"nodes[0]"});
}

TEST(Nodes, MeshesScaledToNothingAreLeftOut) {
  GltfBuilder file;
  const int mesh = file.mesh(file.triangle());
  file.node({{"mesh", mesh}, {"scale", {0, 0, 0}}});
  file.node({{"mesh", mesh}, {"scale", {0, 0, 1}}});
  file.node({{"mesh", mesh}, {"scale", {1, 1, 0}}});
  const Scene scene = file.load();
  EXPECT_EQ(scene.instances.size(), 1u) << "flat, but visible";
  expect_messages(scene.warnings, {{"meshes"}});
}

TEST(Nodes, ReadThePriorityOfAMediumFromTheirExtras) {
  GltfBuilder file;
  const int mesh = file.mesh(file.triangle());
  file.node({{"mesh", mesh}});
  file.node({{"mesh", mesh}, {"extras", {{"dielectric_priority", -2.5}, {"other", "text"}}}});
  file.node({{"mesh", mesh}, {"extras", "any JSON is allowed"}});
  file.node({{"mesh", mesh}, {"extras", {{"dielectric_priority", 3000000000}}}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.instances[0].dielectric_priority, 0.0f);
  EXPECT_EQ(scene.instances[1].dielectric_priority, -2.5f);
  EXPECT_EQ(scene.instances[2].dielectric_priority, 0.0f);
  EXPECT_EQ(scene.instances[3].dielectric_priority, 3e9f) << "more than 32 bits";
  EXPECT_LT(scene.instances[0].placement, scene.instances[1].placement);
  // Other applications may use the name for something else.
  for (const json& other : {json("high"), json(1e300), json(nullptr), json::object()}) {
    GltfBuilder odd;
    odd.node({{"mesh", odd.mesh(odd.triangle())}, {"extras", {{"dielectric_priority", other}}}});
    const Scene loaded = odd.load();
    EXPECT_EQ(loaded.instances[0].dielectric_priority, 0.0f);
    expect_messages(loaded.warnings,
                    {{"nodes[0].extras.dielectric_priority", other.dump(), "a finite number"}});
  }
}

TEST(Nodes, HiddenNodesShowNeitherMeshesNorLights) {
  GltfBuilder file;
  file.root["extensionsUsed"] = {"KHR_lights_punctual", "KHR_node_visibility"};
  set_lights(file, {{{"type", "point"}}});
  camera(file);
  const auto visible = [](bool value) { return json{{"visible", value}}; };
  const int mesh = file.mesh(file.triangle());
  // A visible child of a hidden parent is still hidden. Cameras are not affected.
  const int child = file.add(
      "nodes",
      {{"mesh", mesh},
       {"camera", 0},
       {"extensions", {{"KHR_node_visibility", visible(true)}, {"KHR_lights_punctual", {{"light", 0}}}}}});
  file.node(
      {{"mesh", mesh}, {"children", {child}}, {"extensions", {{"KHR_node_visibility", visible(false)}}}});
  file.node({{"mesh", mesh}, {"name", "seen"}, {"extensions", {{"KHR_node_visibility", json::object()}}}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "seen");
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.cameras.size(), 1u);
  EXPECT_TRUE(scene.warnings.empty());
  const Scene all = file.load({.show_hidden = true});
  EXPECT_EQ(all.instances.size(), 3u);
  EXPECT_EQ(all.lights.size(), 1u);
}

TEST(Nodes, TheSceneCanBeChosen) {
  GltfBuilder file;
  const int mesh = file.mesh(file.triangle());
  file.add("nodes", {{"mesh", mesh}});
  file.add("nodes", {{"mesh", mesh}, {"translation", {7, 0, 0}}});
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(only_mesh(file.load()).positions[0].x(), 0.0f) << "the first without a default";
  EXPECT_EQ(only_mesh(file.load({.scene = 1})).positions[0].x(), 7.0f);
  file.root["scene"] = 1;
  EXPECT_EQ(only_mesh(file.load()).positions[0].x(), 7.0f) << "the file's default";
  EXPECT_EQ(only_mesh(file.load({.scene = 0})).positions[0].x(), 0.0f);
  file.expect_refused({"scene 2"}, {.scene = 2});
}

TEST(Cameras, StandWhereTheirNodesPutThem) {
  GltfBuilder file;
  file.add("cameras", {{"type", "perspective"},
                       {"name", "eye"},
                       {"perspective", {{"yfov", 0.9}, {"znear", 0.1}, {"aspectRatio", 1.25}}}});
  file.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
  const float s = std::sqrt(0.5f);
  file.add("nodes", {{"camera", 0}, {"translation", {0, 0, 1}}, {"scale", {3, 5, 0.5}}});
  file.node(
      {{"children", {0}}, {"rotation", {0, s, 0, s}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}});
  file.node({{"camera", 1}, {"name", "top"}, {"scale", {-1, 1, 1}}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& eye = scene.cameras[0];
  EXPECT_EQ(eye.name, "eye");
  EXPECT_FALSE(eye.orthographic);
  EXPECT_FLOAT_EQ(eye.vertical_fov, 0.9f);
  EXPECT_FLOAT_EQ(eye.aspect, 1.25f);
  EXPECT_TRUE(eye.transform.translation().isApprox(Vec3(12, 0, 0))) << "the parent's scale moves it";
  EXPECT_TRUE(Vec3(-eye.transform.linear().col(2)).isApprox(Vec3(-1, 0, 0))) << "a quarter turn from -z";
  EXPECT_TRUE(Vec3(eye.transform.linear().col(1)).isApprox(Vec3(0, 1, 0)));
  for (const Camera& c : scene.cameras) {
    const Eigen::Matrix3f r = c.transform.linear();
    EXPECT_TRUE(Eigen::Matrix3f(r.transpose() * r).isApprox(Eigen::Matrix3f::Identity(), 1e-5f))
        << "without scale";
    EXPECT_NEAR(r.determinant(), 1.0f, 1e-5f);
  }
  const Camera& top = scene.cameras[1];
  EXPECT_EQ(top.name, "top");
  EXPECT_TRUE(top.orthographic);
  EXPECT_EQ(top.half_height, 2.0f);
  EXPECT_EQ(top.half_width, 3.0f);
  file.root["cameras"][0]["perspective"].erase("aspectRatio");
  EXPECT_EQ(file.load().cameras[0].aspect, 0.0f) << "the picture's";
}

TEST(Lights, CarryIntensityPlaceAndCone) {
  GltfBuilder file;
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  const json lights = {
      {{"type", "directional"}, {"name", "sun"}, {"intensity", 3}, {"color", {1, 0.5, 0.25}}},
      {{"type", "point"}, {"range", 12}},
      {{"type", "spot"}, {"intensity", 2}, {"spot", {{"innerConeAngle", 0.3}, {"outerConeAngle", 0.6}}}},
      {{"type", "spot"}, {"spot", json::object()}}};
  set_lights(file, lights);
  const float s = std::sqrt(0.5f);
  file.node({{"extensions", light_of_node(0)}, {"rotation", {-s, 0, 0, s}}, {"scale", {5, 5, 5}}});
  file.node({{"extensions", light_of_node(1)}, {"translation", {1, 2, 3}}, {"name", "lamp"}});
  file.node({{"extensions", light_of_node(2)}});
  file.node({{"extensions", light_of_node(3)}});
  const Scene scene = file.load();
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0].type, LightType::directional);
  EXPECT_EQ(scene.lights[0].name, "sun");
  EXPECT_TRUE(scene.lights[0].intensity.isApprox(Color(3, 1.5f, 0.75f)));
  EXPECT_TRUE(scene.lights[0].direction.isApprox(Vec3(0, -1, 0))) << "down, and unit";
  EXPECT_EQ(scene.lights[1].type, LightType::point);
  EXPECT_EQ(scene.lights[1].name, "lamp");
  EXPECT_EQ(scene.lights[1].position, Vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[1].range, 12.0f);
  EXPECT_TRUE(scene.lights[1].intensity.isApprox(Color(1, 1, 1)));
  EXPECT_EQ(scene.lights[2].range, kInfinity);
  EXPECT_FLOAT_EQ(scene.lights[2].cos_inner, std::cos(0.3f));
  EXPECT_FLOAT_EQ(scene.lights[2].cos_outer, std::cos(0.6f));
  EXPECT_FLOAT_EQ(scene.lights[3].cos_inner, 1.0f);
  EXPECT_NEAR(scene.lights[3].cos_outer, std::sqrt(0.5f), 1e-6f);
}

/// Returns a scene with an image-based light of six images of one pixel.
GltfBuilder with_image_light() {
  GltfBuilder file;
  file.node({{"mesh", file.mesh(file.triangle())}});
  json faces = json::array();
  for (int f = 0; f < 6; ++f) faces.push_back(file.add("images", {{"uri", kRgbaUri}}));
  file.root["extensionsUsed"] = {"EXT_lights_image_based"};
  file.root["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"name", "studio"}, {"intensity", 2}, {"rotation", {0, 2, 0, 2}}, {"specularImages", {faces}}}};
  file.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  return file;
}

TEST(ImageLight, ComesWithItsFacesAndItsRotation) {
  const Scene scene = with_image_light().load();
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_TRUE(scene.image_light);
  const ImageBasedLight& light = *scene.image_light;
  EXPECT_EQ(light.name, "studio");
  EXPECT_EQ(light.intensity, 2.0f);
  for (const Image& face : light.faces) EXPECT_EQ(face.width, 2);
  EXPECT_TRUE((light.rotation * Vec3::UnitZ()).isApprox(Vec3::UnitX(), 1e-6f)) << "a quarter turn about y";
  GltfBuilder other = with_image_light();
  other.root["scenes"][0].erase("extensions");
  EXPECT_FALSE(other.load().image_light);
}

TEST(ImageLight, OthersBeforeItNeedNotBeUsed) {
  GltfBuilder file = with_image_light();
  json& lights = file.root["extensions"]["EXT_lights_image_based"]["lights"];
  lights = {{{"name", "unused"}}, lights[0]};
  file.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
  const Scene scene = file.load();
  ASSERT_TRUE(scene.image_light);
  EXPECT_EQ(scene.image_light->name, "studio");
}

TEST(ImageLight, WrongFacesAreRefused) {
  GltfBuilder file = with_image_light();
  json& light = file.root["extensions"]["EXT_lights_image_based"]["lights"][0];
  light["specularImages"][0].push_back(0);
  file.expect_refused({"specularImages[0]", "an array of 7", "an array of 6"});
  light["specularImages"] = json::array();
  file.expect_refused({"specularImages", "empty"});
  light["specularImages"] = {{0, 1, 2, 3, 4, 6}};
  file.expect_refused({"specularImages[0][5]", "6", "of size 6"});
  light["specularImages"] = {{0, 1, 2, 3, 4, 5}};
  light["rotation"] = {0, 0, 0, 0};
  file.expect_refused({"rotation", "unit quaternion"});
  file.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
  const Scene scene = file.load();
  EXPECT_FALSE(scene.image_light);
  expect_messages(scene.warnings, {{"scenes[0]", "of size 1"}});
}

TEST(Instancing, PlacesTheMeshInEachTransform) {
  GltfBuilder file;
  const int t = file.accessor(std::vector<float>{0, 0, 0, 10, 0, 0}, kFloat, "VEC3", 2);
  const int r = file.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 23170, 23170}, kShort, "VEC4",
                              2, {{"normalized", true}});
  const int scale = file.accessor(std::vector<float>{1, 1, 1, 2, 3, 4}, kFloat, "VEC3", 2);
  file.node({{"mesh", file.mesh(file.triangle())},
             {"translation", {0, 0, 1}},
             {"extensions", instancing({{"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", scale}})}});
  const Scene scene = file.load({.bake_transforms = false});
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_TRUE(world_triangle(scene, scene.instances[0], 0)[1].isApprox(Vec3(1, 0, 1)));
  EXPECT_TRUE(world_triangle(scene, scene.instances[1], 0)[1].isApprox(Vec3(10, 2, 1), 1e-4f))
      << "scaled, then turned";
}

TEST(Instancing, CountsThatDifferAreRefused) {
  GltfBuilder file;
  const int t = file.accessor(std::vector<float>(6, 0.0f), kFloat, "VEC3", 2);
  const int scale = file.accessor(std::vector<float>(9, 1.0f), kFloat, "VEC3", 3);
  file.node({{"mesh", file.mesh(file.triangle())},
             {"extensions", instancing({{"TRANSLATION", t}, {"SCALE", scale}})}});
  file.expect_refused({"accessors[0]", "2", "TRANSLATION", "nodes[0]", "3"});
}

TEST(Instancing, CustomAttributesSetTheCountToo) {
  for (const int count : {2, 0}) {
    GltfBuilder file;
    json attributes = json::object();
    if (count > 0) {
      attributes["_ID"] = file.accessor(std::vector<float>{7, 8}, kFloat, "SCALAR", 2);
    }
    file.node({{"mesh", file.mesh(file.triangle())}, {"extensions", instancing(attributes)}});
    const Scene scene = file.load({.bake_transforms = false});
    ASSERT_EQ(scene.instances.size(), count > 0 ? 2u : 1u);
    EXPECT_TRUE(world_triangle(scene, scene.instances.back(), 0)[1].isApprox(Vec3(1, 0, 0)));
    expect_messages(scene.warnings,
                    std::vector<tests::NameList>(count > 0 ? 0 : 1, {"EXT_mesh_gpu_instancing"}));
  }
}

}  // namespace
}  // namespace gatelight::scene
