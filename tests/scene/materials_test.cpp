#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>

#include "tests/support/gltf_parts.h"

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

/// A number in the JSON of a material: whole numbers and fractions, which tinygltf keeps in different types.
struct Factor {
  const char* pointer;
  json value;
  float Material::*member;
};

const Factor kFactors[] = {
    {"/pbrMetallicRoughness/metallicFactor", 0.5, &Material::metallic},
    {"/pbrMetallicRoughness/roughnessFactor", 0.625, &Material::roughness},
    {"/normalTexture/scale", 0.75, &Material::normal_scale},
    {"/alphaCutoff", 0.25, &Material::alpha_cutoff},
    {"/extensions/KHR_materials_ior/ior", 2, &Material::ior},
    {"/extensions/KHR_materials_specular/specularFactor", 0.25, &Material::specular},
    {"/extensions/KHR_materials_transmission/transmissionFactor", 1, &Material::transmission},
    {"/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 0.75,
     &Material::diffuse_transmission},
    {"/extensions/KHR_materials_volume/thicknessFactor", 2, &Material::thickness},
    {"/extensions/KHR_materials_volume/attenuationDistance", 5000000000, &Material::attenuation_distance},
    {"/extensions/KHR_materials_dispersion/dispersion", 1, &Material::dispersion},
    {"/extensions/KHR_materials_iridescence/iridescenceFactor", 1, &Material::iridescence},
    {"/extensions/KHR_materials_iridescence/iridescenceIor", 1.75, &Material::film_ior},
    {"/extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", 50,
     &Material::film_thickness_minimum},
    {"/extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", 600.5,
     &Material::film_thickness_maximum},
    {"/extensions/KHR_materials_anisotropy/anisotropyStrength", 0.5, &Material::anisotropy},
    {"/extensions/KHR_materials_anisotropy/anisotropyRotation", -1.5, &Material::anisotropy_rotation},
    {"/extensions/KHR_materials_clearcoat/clearcoatFactor", 1, &Material::clearcoat},
    {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 0.125, &Material::clearcoat_roughness},
    {"/extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", 2,
     &Material::clearcoat_normal_scale},
    {"/extensions/KHR_materials_sheen/sheenRoughnessFactor", 1, &Material::sheen_roughness}};

struct ColorFactor {
  const char* pointer;
  std::array<float, 3> value;
  Color Material::*member;
};

const ColorFactor kColors[] = {
    {"/extensions/KHR_materials_specular/specularColorFactor", {1, 2, 0.5f}, &Material::specular_color},
    {"/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor",
     {0, 1, 0.5f},
     &Material::diffuse_transmission_color},
    {"/extensions/KHR_materials_volume/attenuationColor", {1, 0, 0.5f}, &Material::attenuation_color},
    {"/extensions/KHR_materials_sheen/sheenColorFactor", {0, 0.5f, 1}, &Material::sheen_color}};

struct NamedSlot {
  const char* pointer;
  TextureSlot Material::*member;
};

const NamedSlot kSlots[] = {
    {"/pbrMetallicRoughness/baseColorTexture", &Material::base_color_texture},
    {"/pbrMetallicRoughness/metallicRoughnessTexture", &Material::metallic_roughness_texture},
    {"/normalTexture", &Material::normal_texture},
    {"/emissiveTexture", &Material::emission_texture},
    {"/extensions/KHR_materials_specular/specularTexture", &Material::specular_texture},
    {"/extensions/KHR_materials_specular/specularColorTexture", &Material::specular_color_texture},
    {"/extensions/KHR_materials_transmission/transmissionTexture", &Material::transmission_texture},
    {"/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionTexture",
     &Material::diffuse_transmission_texture},
    {"/extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorTexture",
     &Material::diffuse_transmission_color_texture},
    {"/extensions/KHR_materials_iridescence/iridescenceTexture", &Material::iridescence_texture},
    {"/extensions/KHR_materials_iridescence/iridescenceThicknessTexture", &Material::film_thickness_texture},
    {"/extensions/KHR_materials_anisotropy/anisotropyTexture", &Material::anisotropy_texture},
    {"/extensions/KHR_materials_clearcoat/clearcoatTexture", &Material::clearcoat_texture},
    {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessTexture", &Material::clearcoat_roughness_texture},
    {"/extensions/KHR_materials_clearcoat/clearcoatNormalTexture", &Material::clearcoat_normal_texture},
    {"/extensions/KHR_materials_sheen/sheenColorTexture", &Material::sheen_color_texture},
    {"/extensions/KHR_materials_sheen/sheenRoughnessTexture", &Material::sheen_roughness_texture}};

TEST(Materials, EveryValueIsRead) {
  json material = {{"name", "steel"}, {"alphaMode", "MASK"}, {"doubleSided", true}};
  material["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 0, 0.75};
  material["emissiveFactor"] = {1, 0.5, 0};
  material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 40;
  // Each texture has a scale of its own. The coordinates of the transform replace those of the texture.
  for (std::size_t i = 0; i < std::size(kSlots); ++i) {
    const json transform = {{"scale", {i + 2, 0.5}}, {"offset", {0, 1}}, {"texCoord", 1}};
    material[json::json_pointer(kSlots[i].pointer)] = {
        {"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  }
  for (const Factor& f : kFactors) material[json::json_pointer(f.pointer)] = f.value;
  for (const ColorFactor& f : kColors) material[json::json_pointer(f.pointer)] = f.value;
  const Material m = only_material(material);
  EXPECT_EQ(m.name, "steel");
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_TRUE(m.double_sided);
  EXPECT_TRUE((m.base_color == Color(0.5f, 0.25f, 0)).all());
  EXPECT_EQ(m.base_alpha, 0.75f);
  EXPECT_TRUE((m.emission == Color(40, 20, 0)).all());
  EXPECT_TRUE(m.has_volume());
  for (const Factor& f : kFactors) EXPECT_EQ(m.*f.member, f.value.get<float>()) << f.pointer;
  for (const ColorFactor& f : kColors)
    EXPECT_TRUE((m.*f.member == Color(f.value[0], f.value[1], f.value[2])).all()) << f.pointer;
  for (std::size_t i = 0; i < std::size(kSlots); ++i) {
    const TextureSlot& slot = m.*kSlots[i].member;
    Eigen::Matrix<float, 2, 3> expected;
    expected << static_cast<float>(i + 2), 0, 0, 0, 0.5f, 1;
    EXPECT_TRUE(slot) << kSlots[i].pointer;
    EXPECT_EQ(slot.texcoord, 1) << kSlots[i].pointer;
    EXPECT_EQ(slot.transform, expected) << kSlots[i].pointer;
  }
}

TEST(Materials, DefaultsAreThoseOfTheSpecification) {
  json empty;  // extensions without values
  for (const Factor& f : kFactors) {
    const json::json_pointer extension = json::json_pointer(f.pointer).parent_pointer();
    if (extension.parent_pointer().to_string() == "/extensions") empty[extension] = json::object();
  }
  const Material defaults;
  for (const Material& m : {only_material(json::object()), only_material(empty)}) {
    EXPECT_TRUE((m.base_color == Color(1, 1, 1)).all());
    EXPECT_EQ(m.metallic, 1.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(m.alpha_cutoff, 0.5f);
    EXPECT_EQ(m.film_thickness_minimum, 100.0f);
    EXPECT_EQ(m.attenuation_distance, kInfinity);
    EXPECT_FALSE(m.emits() || m.transmits() || m.double_sided || m.unlit);
    for (const Factor& f : kFactors) EXPECT_EQ(m.*f.member, defaults.*f.member) << f.pointer;
    for (const ColorFactor& f : kColors) EXPECT_TRUE((m.*f.member == defaults.*f.member).all()) << f.pointer;
  }
}

TEST(Materials, WrapsAndFiltersOfTexturesAreRead) {
  const Scene scene = load_material(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}, {"normalTexture", {{"index", 1}}}});
  const Material& m = scene.materials.at(0);
  ASSERT_EQ(scene.textures.size(), 2u);
  const Texture& plain = scene.textures[static_cast<std::size_t>(m.base_color_texture.texture)];
  const Texture& other = scene.textures[static_cast<std::size_t>(m.normal_texture.texture)];
  EXPECT_EQ(plain.wrap_s, Wrap::repeat);
  EXPECT_FALSE(plain.nearest);
  EXPECT_EQ(other.wrap_s, Wrap::clamp_to_edge);
  EXPECT_EQ(other.wrap_t, Wrap::mirrored_repeat);
  EXPECT_TRUE(other.nearest);
  EXPECT_EQ(scene.images.size(), 1u) << "two textures, one picture";
}

TEST(Materials, UnlitIsReadAndAnIorBelowOneIsZeroOrOne) {
  EXPECT_TRUE(only_material(extension("KHR_materials_unlit", json::object())).unlit);
  EXPECT_EQ(only_material(extension("KHR_materials_ior", {{"ior", 0}})).ior, 0.0f);
  EXPECT_EQ(only_material(extension("KHR_materials_ior", {{"ior", 0.5}})).ior, 1.0f);
}

TEST(Materials, APrimitiveWithoutMaterialGetsTheDefault) {
  GltfBuilder file;
  file.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  file.node({{"mesh", file.mesh(file.triangle())}});
  const Scene scene = file.load();
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.material_of(scene.instances[0]).metallic, 1.0f);
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

TEST(Materials, OnlyVolumesDisperse) {
  json material = extension("KHR_materials_dispersion", {{"dispersion", 0.36}});
  EXPECT_FLOAT_EQ(only_material(material).dispersion, 0.36f);
  material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1;
  EXPECT_FALSE(only_material(material).disperses()) << "a sheet does not refract";
  material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = 1;
  EXPECT_TRUE(only_material(material).disperses());
}

TEST(Materials, AnAnisotropicMeshTakesTangentsFromItsTextureCoordinates) {
  const json anisotropic = extension("KHR_materials_anisotropy", {{"anisotropyStrength", 0.6}});
  const Scene scene = load_material(anisotropic);
  ASSERT_EQ(scene.meshes.at(0).tangents.size(), 3u);
  EXPECT_TRUE(scene.meshes[0].tangents[0].isApprox(Vec4(1, 0, 0, 1))) << "along u";
  EXPECT_TRUE(scene.warnings.empty());
  GltfBuilder bare = triangle_of(anisotropic);
  bare.root["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  const Scene without = bare.load();
  EXPECT_TRUE(without.meshes.at(0).tangents.empty());
  expect_messages(without.warnings, {{"anisotropic mesh"}});
}

TEST(Materials, TexturesOfAZeroFactorAreNotRead) {
  const Scene scene =
      load_material({{"emissiveTexture", {{"index", 0}}},
                     {"extensions",
                      {{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 1}}}}},
                       {"KHR_materials_anisotropy", {{"anisotropyTexture", {{"index", 1}}}}},
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

TEST(Materials, RoundingBeyondOneIsNoFault) {
  const Scene scene =
      load_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1.0000001192092896, 0.5, -1e-9, 1}}}}});
  EXPECT_TRUE((scene.materials[0].base_color == Color(1.0f, 0.5f, 0.0f)).all());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Materials, ATexCoordSetBeyondTwoIsIgnoredWithAWarning) {
  const Scene scene =
      load_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 2}}}}}});
  EXPECT_FALSE(scene.materials[0].base_color_texture);
  expect_messages(scene.warnings, {{"texCoord 2"}});
}

TEST(Materials, WrongNumbersAreRefused) {
  const auto expect_refused = [](const json& material, const tests::NameList& names) {
    triangle_of(material).expect_refused(names);
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
  const json transform = {{"offset", {0.1, 0.2}}, {"rotation", angle}, {"scale", {2, 3}}};
  const json info = {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  const TextureSlot slot =
      only_material({{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}).base_color_texture;
  const float c = std::cos(static_cast<float>(angle));
  const float s = std::sin(static_cast<float>(angle));
  // The example of the extension, followed by hand: scale, turn counter-clockwise (v points down), shift.
  const Eigen::Vector3f uv(0.5f, 0.25f, 1.0f);
  const Vec2 scaled(2 * uv.x(), 3 * uv.y());
  const Vec2 expected(c * scaled.x() + s * scaled.y() + 0.1f, -s * scaled.x() + c * scaled.y() + 0.2f);
  EXPECT_TRUE(Vec2(slot.transform * uv).isApprox(expected, 1e-6f));
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
  triangle_file().expect_refused({"dusk"}, {.variant = "dusk"});
}

}  // namespace
}  // namespace gatelight::scene
