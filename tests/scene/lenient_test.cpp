// Values that no picture needs, or that a default can stand for: one warning each, and the scene of a file
// without them.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/gltf_parts.h"
#include "tests/support/small_pngs.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;

/// A scene with one of everything: a textured triangle, a spot light and two cameras. Other elements are
/// there that the scene does not show.
GltfBuilder whole_file() {
  GltfBuilder file;
  file.add("images", {{"uri", kPixelUri}});
  file.add("samplers", json::object());
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  json primitive = file.triangle();
  primitive["material"] =
      file.add("materials",
               {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}, {"doubleSided", true}});
  primitive["indices"] = file.indices({0, 1, 2});
  primitive["attributes"]["NORMAL"] =
      file.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  set_lights(file, {{{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}});
  file.node({{"name", "all"},
             {"mesh", file.mesh(primitive)},
             {"camera", camera(file)},
             {"extensions", light_of_node(0)}});
  file.node({{"camera", 1}});
  file.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 0.1}, {"zfar", 9.0}}}});
  file.root["scene"] = 0;
  return file;
}

/// The content of a scene that the values of these tests decide.
std::string content(const Scene& scene) {
  std::string text = fmt::format("{} triangles", count_triangles(scene));
  for (const Mesh& m : scene.meshes) text += fmt::format(", {} normals", m.normals.size());
  for (const Material& m : scene.materials)
    text += fmt::format(", alpha {} {}", static_cast<int>(m.alpha_mode), m.double_sided);
  for (const PunctualLight& l : scene.lights)
    text += fmt::format(", light {} {} {} {}", static_cast<int>(l.type), l.range, l.cos_inner, l.cos_outer);
  for (const Camera& c : scene.cameras) text += fmt::format(", camera {} {}", c.vertical_fov, c.aspect);
  return text;
}

struct Flaw {
  std::string pointer;  ///< into the JSON
  json value;
  const char* name;          ///< in the warning
  const char* instead = "";  ///< JSON of the value that is taken; empty: none
};

const Flaw kFlaws[] = {
    {"/scene", 7, "scene"},
    {"/scenes/0/name", 5, "scenes[0].name"},
    {"/extensionsUsed", "KHR_lights_punctual", "extensionsUsed"},
    {"/asset/version", 2.0, "asset.version", "\"2.0\""},
    {"/nodes/0/name", 5, "nodes[0].name"},
    {"/nodes/0/camera", 9, "nodes[0].camera"},
    {"/nodes/0/rotation", json::array({0, 0, 0, 0}), "rotation"},
    {"/nodes/0/extensions/KHR_lights_punctual", {{"light", 3}}, "nodes[0].extensions.KHR_lights_punctual"},
    {"/scenes/0/nodes", json::array({0, 1, 0}), "listed twice", "[0, 1]"},
    {"/bufferViews/0/byteStride", 0, "byteStride 0"},
    {"/bufferViews/0/target", "x", "target"},
    {"/accessors/0/normalized", 1, "normalized"},
    {"/meshes/0/primitives/0/mode", 9, "mode"},
    {"/meshes/0/name", json::array(), "meshes[0].name"},
    {"/materials/0/alphaMode", "GLASS", "alphaMode"},
    {"/materials/0/alphaCutoff", -1, "alphaCutoff"},
    {"/materials/0/doubleSided", 1, "doubleSided"},
    {"/cameras/0/perspective/aspectRatio", 0, "aspectRatio"},
    {"/cameras/0/perspective/aspectRatio", -1, "aspectRatio"},
    {"/cameras/0/perspective/znear", 0, "znear", "0.1"},
    {"/cameras/0/perspective/zfar", -3, "zfar"},
    {"/cameras/1/orthographic/zfar", "far", "zfar", "9.0"},
    {"/extensions/KHR_lights_punctual/lights/0/range", 0, "range"},
    {"/extensions/KHR_lights_punctual/lights/0/range", -1, "range"},
    {"/extensions/KHR_lights_punctual/lights/0/name", 0, "name"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", -0.1, "innerConeAngle"},
    {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", 0, "outerConeAngle"}};

TEST(LenientFile, LoadsAsWithoutTheValueWithOneWarning) {
  ASSERT_TRUE(whole_file().load().warnings.empty());
  for (const auto& [pointer, value, name, instead] : kFlaws) {
    SCOPED_TRACE(::testing::Message() << pointer << " = " << value);
    GltfBuilder flawed = whole_file(), sound = whole_file();
    const json::json_pointer place(pointer);
    flawed.root[place] = value;
    if (*instead != '\0') {
      sound.root[place] = json::parse(instead);
    } else if (json& parent = sound.root[place.parent_pointer()]; parent.is_object()) {
      parent.erase(place.back());
    }
    const Scene scene = flawed.load();
    EXPECT_EQ(content(scene), content(sound.load()));
    expect_messages(scene.warnings, {{name}});
  }
}

TEST(Lenient, EquallyWideAndSwappedConesHaveAHardEdge) {
  for (const double inner : {0.6, 0.9}) {
    GltfBuilder file = whole_file();
    file.root["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["innerConeAngle"] = inner;
    const Scene scene = file.load();
    EXPECT_EQ(scene.lights.at(0).cos_inner, scene.lights.at(0).cos_outer);
    EXPECT_FLOAT_EQ(scene.lights[0].cos_outer, std::cos(0.6f));
    expect_messages(scene.warnings, {{"lights[0].spot", "innerConeAngle", "hard edge"}});
  }
}

TEST(Lenient, LightsWithoutATypeOrItsMembers) {
  GltfBuilder file = whole_file();
  json& light = file.root["extensions"]["KHR_lights_punctual"]["lights"][0];
  light.erase("spot");
  Scene scene = file.load();
  EXPECT_NEAR(scene.lights.at(0).cos_outer, std::sqrt(0.5f), 1e-6f);
  expect_messages(scene.warnings, {{"lights[0]", "spot"}});
  light["type"] = "ambient";
  scene = file.load();
  EXPECT_TRUE(scene.lights.empty());
  expect_messages(scene.warnings, {{"type", "ambient"}, {"lights[0]", "ignored"}});
}

TEST(Lenient, SamplersRepeatWhereTheirModeIsUnknown) {
  GltfBuilder file = whole_file();
  file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  file.root["samplers"][0] = {{"wrapS", 0}, {"wrapT", 33071}, {"magFilter", 1}, {"minFilter", "LINEAR"}};
  Scene scene = file.load();
  EXPECT_EQ(scene.textures.at(0).wrap_s, Wrap::repeat);
  EXPECT_EQ(scene.textures[0].wrap_t, Wrap::clamp_to_edge);
  expect_messages(scene.warnings, {{"magFilter"}, {"minFilter"}, {"wrapS"}});
  file.root["samplers"][0] = json::object();
  file.root["textures"][0]["sampler"] = 4;
  scene = file.load();
  EXPECT_EQ(scene.textures.at(0).wrap_s, Wrap::repeat);
  expect_messages(scene.warnings, {{"textures[0].sampler"}});
}

TEST(Lenient, EmptyAndPositionlessPrimitivesAreLeftOut) {
  GltfBuilder file = whole_file();
  const int none = zeros(file, kFloat, "VEC3", 0);
  const int some = file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int no_index = zeros(file, kUnsignedInt, "SCALAR", 0);
  const int view = file.add("bufferViews", {{"buffer", 0}, {"byteLength", 0}});
  const int empty_view = accessor_of_view(file, view, kFloat, "VEC3", 0);
  for (const json& primitive :
       {json{{"attributes", json::object()}}, json{{"attributes", {{"NORMAL", some}}}},
        json{{"attributes", {{"POSITION", none}}}}, json{{"attributes", {{"POSITION", empty_view}}}},
        json{{"attributes", {{"POSITION", none}}}, {"indices", file.indices({0, 1, 2})}},
        json{{"attributes", {{"POSITION", some}}}, {"indices", no_index}}}) {
    GltfBuilder with = file;
    with.node({{"mesh", with.mesh(primitive)}});
    const Scene scene = with.load();
    EXPECT_EQ(count_triangles(scene), 1u) << primitive;
    expect_messages(scene.warnings, {{"meshes[1].primitives[0]", "ignored"}});
  }
  GltfBuilder with = file;
  with.root["meshes"].push_back({{"primitives", json::array()}});
  with.root["meshes"].push_back(json::object());
  with.node({{"mesh", 1}});
  with.node({{"mesh", 2}});
  EXPECT_TRUE(with.load().warnings.empty()) << "nothing is lost";
}

TEST(Lenient, AttributesOfAWrongFormCountAsMissing) {
  GltfBuilder file = whole_file();
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = file.positions({0, 0, 1, 0, 0, 1});
  attributes["COLOR_0"] = file.accessor(std::vector<float>{1, 1, 1, 1, 1, 1}, kFloat, "VEC2", 3);
  const Scene scene = file.load();
  EXPECT_TRUE(scene.meshes.at(0).normals.empty());
  EXPECT_TRUE(scene.meshes[0].colors.empty());
  expect_messages(scene.warnings, {{"2 elements", "NORMAL", "3 vertices"}, {"2 components", "COLOR_0"}});
}

TEST(Lenient, StridesOfAnySizeAreReadAsTheyAre) {
  for (const std::size_t stride : {14u, 18u, 300u}) {
    GltfBuilder file = whole_file();
    std::vector<std::uint8_t> bytes(2 * stride + 12);
    const float xyz[3][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    for (std::size_t i = 0; i < 3; ++i) std::memcpy(&bytes[i * stride], xyz[i], 12);
    const int view = file.view(bytes, {{"byteStride", stride}});
    file.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        accessor_of_view(file, view, kFloat, "VEC3", 3);
    const Scene scene = file.load();
    EXPECT_EQ(scene.bounds.max(), Vec3(2, 3, 0)) << stride;
    expect_messages(scene.warnings, {{"byteStride", std::to_string(stride)}});
  }
}

TEST(Lenient, ElementsThatTheSceneDoesNotShowMayBeBroken) {
  GltfBuilder file = whole_file();
  file.add("accessors", {{"componentType", 5130}, {"type", "QUAT"}});
  file.add("accessors", 5);
  file.add("bufferViews", {{"buffer", 9}, {"byteLength", -1}});
  name_buffers(file, json::array({{{"byteLength", 12}, {"uri", "missing.bin"}}}));
  file.add("cameras", {{"type", "fisheye"}});
  file.add("images", {{"uri", "https://example.com/a.png"}});
  file.add("materials", {{"emissiveFactor", "bright"}});
  file.add("meshes", {{"primitives", 3}});
  file.add("nodes", {{"mesh", 99}});
  file.add("nodes", {{"children", {3}}});
  file.add("skins", {{"joints", "none"}});
  file.add("samplers", {{"wrapS", 0}});
  file.add("textures", {{"source", 9}});
  file.add("scenes", {{"nodes", {77}}});
  file.root["animations"] = {{{"channels", 3}}};
  const Scene scene = file.load();
  EXPECT_EQ(content(scene), content(whole_file().load()));
  EXPECT_TRUE(scene.warnings.empty());
  file.expect_refused({"scenes[1].nodes[0]", "77"}, {.scene = 1});
}

TEST(Lenient, NodesOutsideTheSceneThatPlaceJointsAreRead) {
  GltfBuilder file = whole_file();
  file.root["skins"] = {{{"joints", {3}}}};
  file.root["nodes"][0]["skin"] = 0;
  file.root["nodes"].push_back({{"children", {3}}, {"translation", {0, 0, "x"}}});
  file.root["nodes"].push_back(json::object());
  file.expect_refused({"nodes[2].translation[2]"});
}

TEST(Lenient, ARootThatIsAChildIsShownOnce) {
  GltfBuilder file = triangle_file();
  file.node({{"children", {0}}, {"translation", {5, 0, 0}}});
  Scene scene = file.load();
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.bounds.min().x(), 5.0f) << "below its parent";
  expect_messages(scene.warnings, {{"scenes[0].nodes[0]", "node 0", "child"}});
  file.root["scenes"][0]["nodes"] = {0};
  scene = file.load();
  EXPECT_EQ(scene.bounds.min().x(), 0.0f) << "its parent is not in the scene";
  expect_messages(scene.warnings, {{"scenes[0].nodes[0]", "node 0", "root"}});
}

TEST(Lenient, AFileWithoutScenesShowsAllItsNodes) {
  GltfBuilder file;
  file.add("nodes", {{"mesh", file.mesh(file.triangle())}});
  file.add("nodes", {{"children", {0}}, {"translation", {5, 0, 0}}});
  const Scene scene = file.load();
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.bounds.min().x(), 5.0f);
  expect_messages(scene.warnings, {{"no scene"}});
}

TEST(Lenient, WarningsThatDifferInNumbersOnlyAreCounted) {
  GltfBuilder file = whole_file();
  for (int i = 0; i < 5; ++i) file.node({{"name", i}});
  expect_messages(file.load().warnings, {{"nodes[2].name", "4 more"}});
}

TEST(Lenient, RequiredExtensionsThatChangeNoPicturePass) {
  GltfBuilder file = whole_file();
  file.root["extensionsRequired"] = {"KHR_physics_rigid_bodies", "KHR_xmp_json_ld"};
  expect_messages(file.load().warnings, {{"KHR_physics_rigid_bodies", "KHR_xmp_json_ld"}});
  file.root["extensionsRequired"].push_back("ACME_strange");
  file.root["extensionsRequired"].push_back("ACME_odd");
  file.expect_refused({"ACME_strange, ACME_odd", "`ignore-required` ACME_strange,ACME_odd"});
  LoadOptions options;
  options.ignore_required = {"ACME_strange", "ACME_odd"};
  expect_messages(file.load(options).warnings,
                  {{"KHR_physics_rigid_bodies", "KHR_xmp_json_ld", "ACME_strange", "ACME_odd"}});
}

TEST(Lenient, BackslashesInUrisAreSlashes) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "data");
  GltfBuilder file = whole_file();
  while (file.bin.size() % 4 != 0) file.bin.push_back(0);
  write_bytes(folder.path() / "data" / "a b.bin", file.bin);
  for (const char* uri : {"data\\a b.bin", ".\\data\\a%20b.bin", "data%5Ca b.bin"}) {
    file.root["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", uri}}};
    std::ofstream(folder.path() / "test.gltf") << file.root.dump();
    const Scene scene = load_gltf(folder.path() / "test.gltf");
    EXPECT_EQ(count_triangles(scene), 1u);
    expect_messages(scene.warnings, {{"buffers[0].uri", "backslashes"}});
  }
  for (const char* uri : {"..\\test.bin", "\\etc\\passwd", "data\\..\\..\\x"}) {
    file.root["buffers"][0]["uri"] = uri;
    std::ofstream(folder.path() / "test.gltf") << file.root.dump();
    expect_refused(folder.path() / "test.gltf", {"buffers[0].uri"});
  }
}

TEST(Lenient, ABufferMayEndEarlyWhereNothingIsRead) {
  GltfBuilder file = whole_file();
  name_buffers(file);
  file.root["buffers"][0]["byteLength"] = file.bin.size() + 1000;
  const Scene scene = file.load();
  EXPECT_EQ(content(scene), content(whole_file().load()));
  expect_messages(scene.warnings, {{"buffers[0]", "byteLength"}});
  const int view =
      file.add("bufferViews", {{"buffer", 0}, {"byteOffset", file.bin.size()}, {"byteLength", 36}});
  file.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      accessor_of_view(file, view, kFloat, "VEC3", 3);
  file.expect_refused({"36 bytes", "buffer 0"});
}

}  // namespace
}  // namespace gatelight::scene
