// tinygltf reads what the schema has accepted: the values of every extension arrive, and files on which
// tinygltf alone would crash, or take memory without limit, are refused or load.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;

GltfBuilder triangle_file() {
  GltfBuilder file;
  json primitive = file.triangle();
  primitive["material"] = 0;
  file.node({{"mesh", file.mesh(primitive)}});
  return file;
}

GltfBuilder with_extensions(json extensions) {
  GltfBuilder file = triangle_file();
  file.add("materials", {{"extensions", std::move(extensions)}});
  return file;
}

const char* const kPixel =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4//8/AAX+Av4N70a4AAAAAElFTkSuQmCC";

/// Whole numbers, fractions and lists of both: tinygltf keeps them in values of different types.
TEST(Tinygltf, ValuesOfMaterialExtensionsArrive) {
  const Material m =
      with_extensions(
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}},
           {"KHR_materials_ior", {{"ior", 2}}},
           {"KHR_materials_specular", {{"specularFactor", 0.25}, {"specularColorFactor", {1, 0.5, 0}}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_diffuse_transmission",
            {{"diffuseTransmissionFactor", 0.75}, {"diffuseTransmissionColorFactor", {0, 1, 0.5}}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 2}, {"attenuationDistance", 5000000000}, {"attenuationColor", {1, 0, 0.5}}}},
           {"KHR_materials_dispersion", {{"dispersion", 1}}},
           {"KHR_materials_iridescence",
            {{"iridescenceFactor", 1},
             {"iridescenceIor", 1.75},
             {"iridescenceThicknessMinimum", 50},
             {"iridescenceThicknessMaximum", 600.5}}},
           {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}, {"anisotropyRotation", 1}}},
           {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.125}}},
           {"KHR_materials_sheen", {{"sheenColorFactor", {0, 0.5, 1}}, {"sheenRoughnessFactor", 1}}}})
          .load()
          .materials.at(0);
  EXPECT_EQ(m.ior, 2.0f);
  EXPECT_EQ(m.specular, 0.25f);
  EXPECT_TRUE((m.specular_color == Color(1, 0.5f, 0)).all());
  EXPECT_EQ(m.transmission, 1.0f);
  EXPECT_EQ(m.diffuse_transmission, 0.75f);
  EXPECT_TRUE((m.diffuse_transmission_color == Color(0, 1, 0.5f)).all());
  EXPECT_EQ(m.thickness, 2.0f);
  EXPECT_EQ(m.attenuation_distance, 5e9f) << "more than 32 bits";
  EXPECT_TRUE((m.attenuation_color == Color(1, 0, 0.5f)).all());
  EXPECT_EQ(m.dispersion, 1.0f);
  EXPECT_EQ(m.iridescence, 1.0f);
  EXPECT_EQ(m.film_ior, 1.75f);
  EXPECT_EQ(m.film_thickness_minimum, 50.0f);
  EXPECT_EQ(m.film_thickness_maximum, 600.5f);
  EXPECT_EQ(m.anisotropy, 0.5f);
  EXPECT_EQ(m.anisotropy_rotation, 1.0f);
  EXPECT_EQ(m.clearcoat, 1.0f);
  EXPECT_EQ(m.clearcoat_roughness, 0.125f);
  EXPECT_TRUE((m.sheen_color == Color(0, 0.5f, 1)).all());
  EXPECT_EQ(m.sheen_roughness, 1.0f);
}

TEST(Tinygltf, EmptyExtensionsMeanTheirDefaults) {
  GltfBuilder file = with_extensions({{"KHR_materials_unlit", json::object()},
                                      {"KHR_materials_volume", json::object()},
                                      {"KHR_materials_clearcoat", json::object()}});
  file.root["nodes"][0]["extensions"]["KHR_node_visibility"] = json::object();
  const Scene scene = file.load();
  EXPECT_TRUE(scene.materials.at(0).unlit);
  EXPECT_EQ(scene.materials.at(0).attenuation_distance, kInfinity);
  EXPECT_EQ(scene.instances.size(), 1u);

  file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", json::object()}};
  expect_messages(file.load().warnings, {{"nodes[0]", "EXT_mesh_gpu_instancing", "no attributes"}});
  file.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_EQ(file.load().instances.size(), 0u);
}

TEST(Tinygltf, TexturesOfExtensionsArrive) {
  const json texture = {
      {"index", 0},
      {"texCoord", 0},
      {"extensions",
       {{"KHR_texture_transform", {{"offset", {1, 0.5}}, {"scale", {2, 4}}, {"texCoord", 1}}}}}};
  GltfBuilder file = with_extensions(
      {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatNormalTexture", texture}}},
       {"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}, {"sheenColorTexture", texture}}}});
  file.root["materials"][0]["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"]["scale"] = 2;
  file.add("textures", {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}});
  file.add("images", {{"uri", kPixel}});
  const Scene scene = file.load();
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.clearcoat_normal_scale, 2.0f);
  for (const TextureSlot* slot : {&m.clearcoat_normal_texture, &m.sheen_color_texture}) {
    EXPECT_EQ(slot->texture, 0);
    EXPECT_EQ(slot->texcoord, 1);
    EXPECT_EQ(slot->transform(0, 0), 2.0f);
    EXPECT_EQ(slot->transform(0, 2), 1.0f);
    EXPECT_EQ(slot->transform(1, 1), 4.0f);
  }
  EXPECT_EQ(scene.images.at(0).width, 1);
}

TEST(Tinygltf, ValuesOfNodesAndLightsArrive) {
  GltfBuilder file = triangle_file();
  file.add("materials", json::object());
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 7}, {"range", 9}, {"name", "lamp"}},
      {{"type", "spot"}, {"color", {1, 0, 0.5}}, {"spot", json::object()}}};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "summer"}}, {{"name", ""}}};
  file.node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  file.node({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.root["nodes"][0]["extras"] = {{"dielectric_priority", 3000000000}, {"other", {1, 2}}};
  const Scene scene = file.load();
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].type, LightType::spot);
  EXPECT_FLOAT_EQ(scene.lights[0].cos_outer, std::sqrt(0.5f));
  EXPECT_TRUE((scene.lights[0].intensity == Color(1, 0, 0.5f)).all());
  EXPECT_EQ(scene.lights[1].name, "lamp");
  EXPECT_EQ(scene.lights[1].range, 9.0f);
  EXPECT_TRUE((scene.lights[1].intensity == Color(7, 7, 7)).all());
  EXPECT_EQ(scene.variants, (std::vector<std::string>{"summer", ""}));
  EXPECT_EQ(scene.instances.at(0).dielectric_priority, 3e9f) << "more than 32 bits";
}

TEST(Tinygltf, IndicesWithoutAViewAreZeros) {
  GltfBuilder file = triangle_file();
  file.add("materials", json::object());
  file.root["meshes"][0]["primitives"][0]["indices"] =
      file.add("accessors", {{"componentType", kUnsignedShort}, {"count", 3}, {"type", "SCALAR"}});
  EXPECT_EQ(file.refused(), "");
}

TEST(Tinygltf, AnyChunksAndLengthsOfAGlbAreRead) {
  GltfBuilder file = triangle_file();
  file.add("materials", json::object());
  std::vector<std::uint8_t> bytes = file.glb();
  const std::size_t json_end = 20 + (bytes[12] | static_cast<std::size_t>(bytes[13]) << 8);
  const std::vector<std::uint8_t> chunk = {1, 0, 0, 0, 'A', 'C', 'M', 'E', 7};
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(json_end), chunk.begin(), chunk.end());
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.glb", bytes);
  EXPECT_EQ(refusal(folder.path() / "test.glb"), "");
}

/// Each would get a copy of the .glb's data.
TEST(Tinygltf, BuffersWithoutASourceTakeNoMemory) {
  GltfBuilder file = triangle_file();
  file.add("materials", json::object());
  file.bin.resize(std::size_t{1} << 20);
  file.root["buffers"] = {{{"byteLength", file.bin.size()}}};
  for (int i = 0; i < 10000; ++i) file.root["buffers"].push_back({{"byteLength", file.bin.size()}});
  EXPECT_EQ(file.refused(), "");
  file.root["bufferViews"][0]["buffer"] = 5;
  file.expect_refused({"accessors[0]", "buffer 5 has no data"});
}

TEST(Tinygltf, NamesOfFilesKeepTheirCharacters) {
  GltfBuilder file = triangle_file();
  file.add("materials", json::object());
  file.root["buffers"] = {{{"byteLength", file.bin.size()}, {"uri", "a+b%zz%20c.bin"}}};
  const TemporaryFolder folder;
  write_bytes(folder.path() / "a+b%zz c.bin", file.bin);
  EXPECT_EQ(refusal(file.write(folder)), "");
}

TEST(Tinygltf, DataUrisThatAreNotBase64AreRefused) {
  for (const char* body : {"QUJD*UJD", "QUJDQ", "QUJD=QUJD", "=QUJ", "QU%zz"}) {
    GltfBuilder file = triangle_file();
    file.add("materials", json::object());
    file.root["buffers"] = {{{"byteLength", file.bin.size()},
                             {"uri", fmt::format("data:application/octet-stream;base64,{}", body)}}};
    file.expect_refused({"buffers[0].uri", "base64"});
  }
}

/// An object of three characters takes thousands of bytes in tinygltf's model.
TEST(Tinygltf, ManyEmptyObjectsAreRefused) {
  std::string text = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{}";
  for (int i = 0; i < 1000000; ++i) text += ",{}";
  text += "]}";
  const TemporaryFolder folder;
  write_bytes(folder.path() / "test.gltf", {text.begin(), text.end()});
  expect_refused(folder.path() / "test.gltf", {"JSON", "MiB", std::to_string(text.size())});
}

/// Values that the loader does not use are not kept, whatever they are.
TEST(Tinygltf, UnknownValuesAreIgnored) {
  GltfBuilder file = triangle_file();
  file.add("materials", {{"extensions", {{"ACME_strange", {{"a", {1, nullptr, "b"}}}}}}, {"extras", 5}});
  file.root["animations"] = "none";
  file.root["accessors"][0]["min"] = "small";
  file.root["images"] = {{{"uri", "absent.png"}, {"width", 1e300}}};
  file.root["extras"] = {1, 2};
  EXPECT_EQ(file.refused(), "");
}

}  // namespace
}  // namespace gatelight::scene
