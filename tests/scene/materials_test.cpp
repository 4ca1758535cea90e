#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {
namespace {

using ::testing::ElementsAre;
using tests::expect_messages;

/// Loads a scene of one triangle with the given material and two textures (of one missing image).
Scene load_material(const json& material, GltfBuilder file = {}) {
  file.add("images", {{"uri", "absent.png"}});
  file.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  file.add("textures", {{"source", 0}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  json primitive = file.triangle();
  primitive["material"] = file.add("materials", material);
  file.node({{"mesh", file.mesh(primitive)}});
  return file.load({.missing_is_error = false});
}

Material only_material(const json& material) {
  const Scene scene = load_material(material);
  EXPECT_EQ(scene.materials.size(), 1u);
  return scene.materials.at(0);
}

json extension(const char* name, json value) {
  return {{"extensions", {{name, std::move(value)}}}};
}

TEST(Materials, CoreFactorsAndTexturesAreRead) {
  const Scene scene = load_material({{"name", "steel"},
                                     {"pbrMetallicRoughness",
                                      {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                                       {"metallicFactor", 0.5},
                                       {"roughnessFactor", 0.6},
                                       {"baseColorTexture", {{"index", 0}}},
                                       {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
                                     {"normalTexture", {{"index", 0}, {"scale", 0.7}}},
                                     {"emissiveFactor", {0.1, 0, 0}},
                                     {"emissiveTexture", {{"index", 1}}},
                                     {"alphaMode", "MASK"},
                                     {"alphaCutoff", 0.3},
                                     {"doubleSided", true}});
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.name, "steel");
  EXPECT_TRUE(m.base_color.isApprox(Color(0.1f, 0.2f, 0.3f)));
  EXPECT_FLOAT_EQ(m.base_alpha, 0.4f);
  EXPECT_FLOAT_EQ(m.metallic, 0.5f);
  EXPECT_FLOAT_EQ(m.roughness, 0.6f);
  EXPECT_FLOAT_EQ(m.normal_scale, 0.7f);
  EXPECT_TRUE(m.base_color_texture);
  EXPECT_EQ(m.metallic_roughness_texture.texcoord, 1);
  EXPECT_TRUE(m.normal_texture);
  EXPECT_TRUE(m.emission_texture);
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_FLOAT_EQ(m.alpha_cutoff, 0.3f);
  EXPECT_TRUE(m.double_sided);
  ASSERT_EQ(scene.textures.size(), 2u);
  const Texture& plain = scene.textures[static_cast<std::size_t>(m.base_color_texture.texture)];
  const Texture& other = scene.textures[static_cast<std::size_t>(m.emission_texture.texture)];
  EXPECT_EQ(plain.wrap_s, Wrap::repeat);
  EXPECT_FALSE(plain.nearest);
  EXPECT_EQ(other.wrap_s, Wrap::clamp_to_edge);
  EXPECT_EQ(other.wrap_t, Wrap::mirrored_repeat);
  EXPECT_TRUE(other.nearest);
  EXPECT_EQ(scene.images.size(), 1u) << "two textures, one picture";
}

TEST(Materials, DefaultsAreThoseOfTheSpecification) {
  const Material m = only_material(json::object());
  EXPECT_TRUE(m.base_color.isApprox(Color(1, 1, 1)));
  EXPECT_EQ(m.metallic, 1.0f);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(m.alpha_cutoff, 0.5f);
  EXPECT_FALSE(m.emits() || m.transmits() || m.double_sided || m.unlit);
  EXPECT_EQ(m.attenuation_distance, kInfinity);
}

TEST(Materials, APrimitiveWithoutMaterialGetsTheDefault) {
  GltfBuilder file;
  file.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  file.node({{"mesh", file.mesh(file.triangle())}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.material_of(scene.instances[0]).metallic, 1.0f);
}

TEST(Materials, EmissiveStrengthMultiplies) {
  json material = extension("KHR_materials_emissive_strength", {{"emissiveStrength", 40}});
  material["emissiveFactor"] = {1, 0.5, 0};
  EXPECT_TRUE(only_material(material).emission.isApprox(Color(40, 20, 0)));
}

TEST(Materials, SpecularGlossinessBecomesADielectricOfThatReflectance) {
  json material =
      extension("KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                                        {"diffuseTexture", {{"index", 0}}},
                                                        {"specularFactor", {0.5, 0.6, 0.7}},
                                                        {"glossinessFactor", 0.75},
                                                        {"specularGlossinessTexture", {{"index", 1}}}});
  material["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 0, 0, 1}}, {"metallicFactor", 1}};
  const Material m = only_material(material);
  EXPECT_TRUE(m.base_color.isApprox(Color(0.1f, 0.2f, 0.3f)));
  EXPECT_FLOAT_EQ(m.base_alpha, 0.4f);
  EXPECT_EQ(m.metallic, 0.0f);
  EXPECT_EQ(m.ior, 0.0f);
  EXPECT_TRUE(m.specular_color.isApprox(Color(0.5f, 0.6f, 0.7f)));
  EXPECT_FLOAT_EQ(m.roughness, 0.25f);
  EXPECT_TRUE(m.base_color_texture && m.specular_color_texture);
  EXPECT_EQ(m.glossiness_texture.texture, m.specular_color_texture.texture);
  const Material defaults = only_material(extension("KHR_materials_pbrSpecularGlossiness", json::object()));
  EXPECT_TRUE((defaults.specular_color == 1.0f).all());
  EXPECT_EQ(defaults.roughness, 0.0f);
}

TEST(Materials, BackFacesAreShownCulledOrLitByOption) {
  GltfBuilder file;
  for (const bool double_sided : {false, true}) {
    for (const bool emits : {false, true}) {
      json primitive = file.triangle();
      primitive["material"] = file.add("materials", {{"doubleSided", double_sided},
                                                     {"emissiveFactor", json::array({emits ? 1 : 0, 0, 0})}});
      file.node({{"mesh", file.mesh(primitive)}});
    }
  }
  json glass = extension("KHR_materials_transmission", {{"transmissionFactor", 1}});
  json primitive = file.triangle();
  primitive["material"] = file.add("materials", glass);
  file.node({{"mesh", file.mesh(primitive)}});
  const auto loaded = [&](BackFaces back_faces) {
    GltfBuilder copy = file;
    std::vector<std::pair<bool, bool>> sides;
    for (const Material& m : copy.load({.back_faces = back_faces}).materials)
      sides.emplace_back(m.double_sided, m.culled);
    return sides;
  };
  using Sides = std::pair<bool, bool>;
  EXPECT_THAT(loaded(BackFaces::show),
              ElementsAre(Sides(false, false), Sides(false, false), Sides(true, false), Sides(true, false),
                          Sides(false, false)));
  EXPECT_THAT(loaded(BackFaces::cull), ElementsAre(Sides(false, true), Sides(false, true), Sides(true, false),
                                                   Sides(true, false), Sides(false, false)));
  EXPECT_THAT(loaded(BackFaces::light),
              ElementsAre(Sides(false, false), Sides(true, false), Sides(true, false), Sides(true, false),
                          Sides(false, false)));
}

TEST(Materials, IorSpecularAndUnlitAreRead) {
  EXPECT_FLOAT_EQ(only_material(extension("KHR_materials_ior", {{"ior", 1.33}})).ior, 1.33f);
  EXPECT_EQ(only_material(extension("KHR_materials_ior", {{"ior", 0}})).ior, 0.0f);
  EXPECT_EQ(only_material(extension("KHR_materials_ior", {{"ior", 0.5}})).ior, 1.0f);
  const Material m =
      only_material(extension("KHR_materials_specular", {{"specularFactor", 0.25},
                                                         {"specularColorFactor", {1, 2, 0.5}},
                                                         {"specularTexture", {{"index", 0}}},
                                                         {"specularColorTexture", {{"index", 1}}}}));
  EXPECT_FLOAT_EQ(m.specular, 0.25f);
  EXPECT_TRUE(m.specular_color.isApprox(Color(1, 2, 0.5f))) << "may be above one";
  EXPECT_TRUE(m.specular_texture && m.specular_color_texture);
  EXPECT_TRUE(only_material(extension("KHR_materials_unlit", json::object())).unlit);
}

TEST(Materials, TransmissionAndVolumeAreRead) {
  json material = extension("KHR_materials_transmission",
                            {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 0}}}});
  EXPECT_FALSE(only_material(material).has_volume());
  material["extensions"]["KHR_materials_volume"] = {
      {"thicknessFactor", 2}, {"attenuationDistance", 3}, {"attenuationColor", {0.5, 0.25, 1}}};
  const Material m = only_material(material);
  EXPECT_FLOAT_EQ(m.transmission, 0.75f);
  EXPECT_TRUE(m.transmission_texture);
  EXPECT_TRUE(m.has_volume());
  EXPECT_EQ(m.attenuation_distance, 3.0f);
  EXPECT_TRUE(m.attenuation_color.isApprox(Color(0.5f, 0.25f, 1)));
}

TEST(Materials, IridescenceIsRead) {
  const Material m = only_material(
      extension("KHR_materials_iridescence", {{"iridescenceFactor", 0.5},
                                              {"iridescenceIor", 1.8},
                                              {"iridescenceThicknessMaximum", 800},
                                              {"iridescenceThicknessTexture", {{"index", 0}}}}));
  EXPECT_EQ(m.iridescence, 0.5f);
  EXPECT_FLOAT_EQ(m.film_ior, 1.8f);
  EXPECT_EQ(m.film_thickness_minimum, 100.0f) << "the extension's default";
  EXPECT_EQ(m.film_thickness_maximum, 800.0f);
  EXPECT_TRUE(m.film_thickness_texture);
  EXPECT_FALSE(m.iridescence_texture);
}

TEST(Materials, OnlyVolumesDisperse) {
  json material = extension("KHR_materials_dispersion", {{"dispersion", 0.36}});
  EXPECT_FLOAT_EQ(only_material(material).dispersion, 0.36f);
  material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  EXPECT_FALSE(only_material(material).disperses()) << "a sheet does not refract";
  material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
  EXPECT_TRUE(only_material(material).disperses());
}

TEST(Materials, DiffuseTransmissionIsRead) {
  const Material plain = only_material(extension("KHR_materials_diffuse_transmission", json::object()));
  EXPECT_EQ(plain.diffuse_transmission, 0.0f);
  EXPECT_FALSE(plain.transmits());
  json material =
      extension("KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.25},
                                                       {"diffuseTransmissionTexture", {{"index", 0}}},
                                                       {"diffuseTransmissionColorFactor", {1, 0.9, 0.5}},
                                                       {"diffuseTransmissionColorTexture", {{"index", 1}}}});
  const Material cloth = only_material(material);
  EXPECT_EQ(cloth.diffuse_transmission, 0.25f);
  EXPECT_TRUE(cloth.diffuse_transmission_color.isApprox(Color(1, 0.9f, 0.5f)));
  EXPECT_TRUE(cloth.transmits());
  EXPECT_TRUE(cloth.diffuse_transmission_texture && cloth.diffuse_transmission_color_texture);
  EXPECT_FALSE(cloth.has_volume());
  material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
  EXPECT_TRUE(only_material(material).has_volume());
}

TEST(Materials, AnisotropyIsRead) {
  const json anisotropic = extension(
      "KHR_materials_anisotropy",
      {{"anisotropyStrength", 0.6}, {"anisotropyRotation", -1.5}, {"anisotropyTexture", {{"index", 0}}}});
  const Material m = only_material(anisotropic);
  EXPECT_FLOAT_EQ(m.anisotropy, 0.6f);
  EXPECT_FLOAT_EQ(m.anisotropy_rotation, -1.5f);
  EXPECT_TRUE(m.anisotropy_texture);
  EXPECT_FALSE(only_material(extension("KHR_materials_anisotropy", {{"anisotropyTexture", {{"index", 0}}}}))
                   .anisotropy_texture)
      << "its factor is zero";
}

TEST(Materials, AnAnisotropicMeshTakesTangentsFromItsTextureCoordinates) {
  const json anisotropic = extension("KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}});
  const Scene scene = load_material(anisotropic);
  ASSERT_EQ(scene.meshes.at(0).tangents.size(), 3u);
  EXPECT_TRUE(scene.meshes[0].tangents[0].isApprox(Vec4(1, 0, 0, 1))) << "along u";
  EXPECT_TRUE(scene.warnings.empty());
  GltfBuilder bare;
  json primitive = bare.triangle();
  primitive["attributes"].erase("TEXCOORD_0");
  primitive["material"] = bare.add("materials", anisotropic);
  bare.node({{"mesh", bare.mesh(primitive)}});
  const Scene without = bare.load();
  EXPECT_TRUE(without.meshes.at(0).tangents.empty());
  expect_messages(without.warnings, {{"anisotropic mesh"}});
}

TEST(Materials, ClearcoatAndSheenAreRead) {
  json material =
      extension("KHR_materials_clearcoat", {{"clearcoatFactor", 0.5},
                                            {"clearcoatTexture", {{"index", 0}}},
                                            {"clearcoatRoughnessFactor", 0.25},
                                            {"clearcoatRoughnessTexture", {{"index", 1}}},
                                            {"clearcoatNormalTexture", {{"index", 0}, {"scale", 2}}}});
  material["extensions"]["KHR_materials_sheen"] = {{"sheenColorFactor", {0.1, 0.2, 0.3}},
                                                   {"sheenColorTexture", {{"index", 0}}},
                                                   {"sheenRoughnessFactor", 0.4},
                                                   {"sheenRoughnessTexture", {{"index", 1}}}};
  const Material m = only_material(material);
  EXPECT_EQ(m.clearcoat, 0.5f);
  EXPECT_EQ(m.clearcoat_roughness, 0.25f);
  EXPECT_EQ(m.clearcoat_normal_scale, 2.0f);
  EXPECT_TRUE(m.clearcoat_texture && m.clearcoat_roughness_texture && m.clearcoat_normal_texture);
  EXPECT_TRUE(m.sheen_color.isApprox(Color(0.1f, 0.2f, 0.3f)));
  EXPECT_FLOAT_EQ(m.sheen_roughness, 0.4f);
  EXPECT_TRUE(m.sheen_color_texture && m.sheen_roughness_texture);
}

TEST(Materials, TexturesOfAZeroFactorAreNotRead) {
  const Scene scene =
      load_material({{"emissiveTexture", {{"index", 0}}},
                     {"extensions",
                      {{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 1}}}}},
                       {"KHR_materials_clearcoat", {{"clearcoatTexture", {{"index", 0}}}}},
                       {"KHR_materials_sheen", {{"sheenColorTexture", {{"index", 0}}}}}}}});
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_TRUE(scene.images.empty());
}

TEST(Materials, FactorsOutsideTheirRangeAreClampedWithAWarning) {
  const Scene scene = load_material(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {2, -1, 0.5, 1}}, {"metallicFactor", -3}}}});
  EXPECT_TRUE(scene.materials[0].base_color.isApprox(Color(1, 0, 0.5f)));
  EXPECT_EQ(scene.materials[0].metallic, 0.0f);
  expect_messages(scene.warnings, {{"2", "1 more"}, {"-3"}});
}

TEST(Materials, ATexCoordSetBeyondTwoIsIgnoredWithAWarning) {
  const Scene scene =
      load_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 2}}}}}});
  EXPECT_FALSE(scene.materials[0].base_color_texture);
  expect_messages(scene.warnings, {{"texCoord 2"}});
}

TEST(Materials, WrongNumbersAreRefused) {
  const auto expect_refused = [](const json& material, const tests::NameList& names) {
    GltfBuilder file;
    json primitive = file.triangle();
    primitive["material"] = file.add("materials", material);
    file.node({{"mesh", file.mesh(primitive)}});
    file.expect_refused(names);
  };
  expect_refused({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1}}}}}, {"baseColorFactor", "4"});
  expect_refused({{"emissiveFactor", {1, 1, "x"}}}, {"emissiveFactor[2]"});
  expect_refused({{"normalTexture", {{"index", 0}}}}, {"normalTexture.index"});
  expect_refused(extension("KHR_materials_ior", {{"ior", -1}}), {"KHR_materials_ior", "ior", "-1"});
  expect_refused(extension("KHR_materials_volume", {{"attenuationDistance", 0}}),
                 {"attenuationDistance", "0"});
  expect_refused(extension("KHR_materials_emissive_strength", {{"emissiveStrength", -1}}),
                 {"emissiveStrength", "-1"});
  expect_refused(extension("KHR_materials_unlit", 5), {"KHR_materials_unlit"});
}

TEST(TextureTransform, IsOffsetTimesRotationTimesScale) {
  const double angle = 0.3;
  const json transform = {{"offset", {0.1, 0.2}}, {"rotation", angle}, {"scale", {2, 3}}, {"texCoord", 1}};
  const json info = {{"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  const TextureSlot slot =
      only_material({{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}).base_color_texture;
  EXPECT_EQ(slot.texcoord, 1) << "the extension's set wins";
  const float c = std::cos(static_cast<float>(angle));
  const float s = std::sin(static_cast<float>(angle));
  // The example of the extension, followed by hand: scale, turn counter-clockwise (v points down), shift.
  const Eigen::Vector3f uv(0.5f, 0.25f, 1.0f);
  const Vec2 scaled(2 * uv.x(), 3 * uv.y());
  const Vec2 expected(c * scaled.x() + s * scaled.y() + 0.1f, -s * scaled.x() + c * scaled.y() + 0.2f);
  EXPECT_TRUE(Vec2(slot.transform * uv).isApprox(expected, 1e-6f));
}

TEST(TextureTransform, AQuarterTurnTakesTheRightEdgeUp) {
  const json info = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"rotation", EIGEN_PI / 2}}}}}};
  const TextureSlot slot =
      only_material({{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}).base_color_texture;
  const Vec2 turned = slot.transform * Eigen::Vector3f(1, 0, 1);
  EXPECT_NEAR(turned.x(), 0.0f, 1e-6f);
  EXPECT_NEAR(turned.y(), -1.0f, 1e-6f) << "up is towards smaller v";
}

TEST(TextureTransform, ReachesTheSlotsOfExtensions) {
  const json info = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {4, 5}}}}}}};
  const Material m = only_material(
      extension("KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", info}}));
  EXPECT_EQ(m.transmission_texture.transform(0, 0), 4.0f);
  EXPECT_EQ(m.transmission_texture.transform(1, 1), 5.0f);
}

GltfBuilder with_variants() {
  GltfBuilder file;
  file.root["extensionsRequired"] = {"KHR_materials_variants"};
  file.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
  for (const char* name : {"plain", "blue", "black"}) file.add("materials", {{"name", name}});
  json primitive = file.triangle();
  primitive["material"] = 0;
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                   {{"material", 2}, {"variants", {1}}}};
  file.node({{"mesh", file.mesh(primitive)}});
  return file;
}

TEST(Variants, ChooseTheMaterial) {
  GltfBuilder file = with_variants();
  const auto name = [&](const std::string& variant) {
    const Scene scene = file.load({.variant = variant});
    EXPECT_THAT(scene.variants, ElementsAre("day", "night"));
    return scene.material_of(scene.instances.at(0)).name;
  };
  EXPECT_EQ(name(""), "plain");
  EXPECT_EQ(name("day"), "blue");
  EXPECT_EQ(name("night"), "black");
}

TEST(Variants, AnUnknownNameIsRefusedWithTheKnownOnes) {
  with_variants().expect_refused({"dusk", "day", "night"}, {.variant = "dusk"});
  GltfBuilder none;
  none.node({{"mesh", none.mesh(none.triangle())}});
  none.expect_refused({"dusk"}, {.variant = "dusk"});
}

}  // namespace
}  // namespace gatelight::scene
