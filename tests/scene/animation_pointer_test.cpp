// Values of materials, lights, cameras and nodes that KHR_animation_pointer animates.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/small_pngs.h"
#include "tests/support/words.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;

/// A triangle with a material, a spot light, and two cameras.
AnimatedFile lit_triangle(const json& material = json::object()) {
  AnimatedFile file;
  file.root["extensionsUsed"] = {"KHR_animation_pointer"};
  json primitive = file.triangle();
  primitive["material"] = file.add("materials", material);
  file.node({{"mesh", file.mesh(primitive)}});
  camera(file);
  file.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1.0}, {"ymag", 1.0}, {"znear", 0.1}, {"zfar", 9.0}}}});
  set_lights(file, {{{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}});
  file.node({{"camera", 0}, {"extensions", light_of_node(0)}});
  file.node({{"camera", 1}});
  return file;
}

Material material_at(AnimatedFile& file, double time) {
  const Scene scene = file.at(time);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  return scene.materials.at(0);
}

TEST(AnimationPointers, FactorsOfAMaterial) {
  AnimatedFile file = lit_triangle({{"alphaMode", "MASK"}});
  const int times = file.seconds({0, 1});
  const int colors = file.quaternions({1, 0, 0, 1, 0, 1, 0, 0.5f});
  file.move("/materials/0/pbrMetallicRoughness/baseColorFactor", {times, colors});
  file.move("/materials/0/pbrMetallicRoughness/metallicFactor", {times, file.scalars({0, 1})});
  file.move("/materials/0/pbrMetallicRoughness/roughnessFactor", {times, file.scalars({1, 0.5f})}, "STEP");
  file.move("/materials/0/alphaCutoff", {times, file.scalars({0.25f, 0.75f})});
  file.move("/materials/0/emissiveFactor", {times, file.vectors({0, 0, 0, 1, 0.5f, 0})});
  const Material m = material_at(file, 0.5);
  EXPECT_TRUE((m.base_color == Color(0.5f, 0.5f, 0)).all());
  EXPECT_EQ(m.base_alpha, 0.75f);
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 1.0f);
  EXPECT_EQ(m.alpha_cutoff, 0.5f);
  EXPECT_TRUE((m.emission == Color(0.5f, 0.25f, 0)).all());
  EXPECT_FALSE(material_at(file, 0.0).emits());
}

TEST(AnimationPointers, ExtensionsOfAMaterial) {
  AnimatedFile file =
      lit_triangle({{"emissiveFactor", {1, 1, 1}},
                    {"extensions",
                     {{"KHR_materials_emissive_strength", json::object()},
                      {"KHR_materials_ior", {{"ior", 1.4}}},
                      {"KHR_materials_transmission", {{"transmissionFactor", 0.0}}},
                      {"KHR_materials_volume", {{"thicknessFactor", 1.0}, {"attenuationDistance", 5.0}}}}}});
  const int times = file.seconds({0, 1});
  const std::string extensions = "/materials/0/extensions/";
  file.move(extensions + "KHR_materials_emissive_strength/emissiveStrength", {times, file.scalars({2, 6})});
  file.move(extensions + "KHR_materials_ior/ior", {times, file.scalars({1, 2})});
  file.move(extensions + "KHR_materials_transmission/transmissionFactor", {times, file.scalars({0, 1})});
  file.move(extensions + "KHR_materials_volume/attenuationDistance", {times, file.scalars({1, 3})});
  file.move(extensions + "KHR_materials_volume/attenuationColor",
            {times, file.vectors({1, 1, 1, 0, 0.5f, 1})});
  const Material m = material_at(file, 0.5);
  EXPECT_EQ(m.emission.x(), 4.0f);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_EQ(m.transmission, 0.5f);
  EXPECT_EQ(m.attenuation_distance, 2.0f);
  EXPECT_TRUE((m.attenuation_color == Color(0.5f, 0.75f, 1)).all());
}

/// Textures with a picture of one pixel, in a slot of the core and one of an extension.
AnimatedFile textured_triangle() {
  const json moved = {{"index", 0}, {"extensions", {{"KHR_texture_transform", json::object()}}}};
  AnimatedFile file = lit_triangle(
      {{"pbrMetallicRoughness", {{"baseColorTexture", moved}}},
       {"normalTexture", {{"index", 0}}},
       {"extensions",
        {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1.0}, {"clearcoatTexture", moved}}}}}});
  file.add("images", {{"uri", kPixelUri}});
  file.add("textures", {{"source", 0}});
  return file;
}

TEST(AnimationPointers, TransformsOfTextures) {
  AnimatedFile file = textured_triangle();
  const int times = file.seconds({0, 1});
  const std::string core =
      "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
  const std::string coat =
      "/materials/0/extensions/KHR_materials_clearcoat/clearcoatTexture/extensions/KHR_texture_transform/";
  const int pairs = file.accessor(std::vector<float>{0, 0, 2, 4}, kFloat, "VEC2", 2);
  file.move(core + "offset", {times, pairs});
  file.move(core + "scale", {times, pairs});
  file.move(coat + "rotation", {times, file.scalars({0, 2})});
  file.move("/materials/0/normalTexture/scale", {times, file.scalars({0, 3})});
  const Material m = material_at(file, 0.5);
  Eigen::Matrix<float, 2, 3> expected;
  expected << 1, 0, 1, 0, 2, 2;
  EXPECT_EQ(m.base_color_texture.transform, expected);
  EXPECT_EQ(m.normal_scale, 1.5f);
  EXPECT_NEAR(m.clearcoat_texture.transform(0, 1), std::sin(1.0f), 1e-6f);
}

TEST(AnimationPointers, Lights) {
  AnimatedFile file = lit_triangle();
  const int times = file.seconds({0, 2});
  const std::string light = "/extensions/KHR_lights_punctual/lights/0/";
  file.move(light + "color", {times, file.vectors({1, 1, 1, 0, 0.5f, 1})});
  file.move(light + "intensity", {times, file.scalars({0, 8})});
  file.move(light + "range", {times, file.scalars({10, 30})});
  file.move(light + "spot/innerConeAngle", {times, file.scalars({0, 0.5f})});
  file.move(light + "spot/outerConeAngle", {times, file.scalars({0.5f, 1})});
  const PunctualLight found = file.at(1.0).lights.at(0);
  EXPECT_TRUE((found.intensity == Color(2, 3, 4)).all());
  EXPECT_EQ(found.range, 20.0f);
  EXPECT_NEAR(found.cos_inner, std::cos(0.25f), 1e-6f);
  EXPECT_NEAR(found.cos_outer, std::cos(0.75f), 1e-6f);
}

TEST(AnimationPointers, Cameras) {
  AnimatedFile file = lit_triangle();
  const int times = file.seconds({0, 1});
  file.move("/cameras/0/perspective/yfov", {times, file.scalars({0.5f, 1.5f})});
  file.move("/cameras/0/perspective/aspectRatio", {times, file.scalars({1, 3})});
  file.move("/cameras/1/orthographic/xmag", {times, file.scalars({1, 5})});
  file.move("/cameras/1/orthographic/ymag", {times, file.scalars({2, 4})});
  const Scene scene = file.at(0.5);
  EXPECT_EQ(scene.cameras[0].vertical_fov, 1.0f);
  EXPECT_EQ(scene.cameras[0].aspect, 2.0f);
  EXPECT_EQ(scene.cameras[1].half_width, 3.0f);
  EXPECT_EQ(scene.cameras[1].half_height, 3.0f);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(AnimationPointers, NodesAsByTheirPaths) {
  AnimatedFile file = moving_triangle();
  file.move("/nodes/0/translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 2, 0, 0})});
  const float s = std::sqrt(0.5f);
  file.move("/nodes/0/rotation", {file.seconds({0, 1}), file.quaternions({0, 0, 0, 1, 0, 0, s, s})});
  const Affine t = file.transform_at(0.5);
  EXPECT_EQ(Vec3(t.translation()), Vec3(1, 0, 0));
  EXPECT_TRUE(t.linear().isApprox(Eigen::AngleAxisf(0.78539816f, Vec3::UnitZ()).toRotationMatrix(), 1e-6f));
}

TEST(AnimationPointers, SingleWeightsAndThoseOfMeshes) {
  AnimatedFile file = morphing_triangle(), of_mesh = file;
  file.move("/nodes/0/weights/1", {file.seconds({0, 1}), file.scalars({0, 4})});
  EXPECT_EQ(only_mesh(file.at(0.25)).positions[0], Vec3(0.25f, 1, 0)) << "the other keeps the mesh's";
  of_mesh.move("/meshes/0/weights", {of_mesh.seconds({0, 1}), of_mesh.scalars({0, 0, 4, 8})});
  EXPECT_EQ(only_mesh(of_mesh.at(0.25)).positions[0], Vec3(1, 2, 0));
}

TEST(AnimationPointers, VisibilityChangesAtItsKeys) {
  AnimatedFile file = moving_triangle({{"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  const int values = file.accessor(std::vector<std::uint8_t>{1, 0, 1}, kUnsignedByte, "SCALAR", 3);
  for (const char* interpolation : {"STEP", "LINEAR"}) {
    AnimatedFile moved = file;
    moved.move("/nodes/0/extensions/KHR_node_visibility/visible", {moved.seconds({0, 1, 2}), values},
               interpolation);
    EXPECT_FALSE(moved.at(0.9).instances.at(0).hidden);
    EXPECT_TRUE(moved.at(1.0).instances.at(0).hidden);
    EXPECT_TRUE(moved.at(1.9).instances.at(0).hidden);
    EXPECT_FALSE(moved.at(2.0).instances.at(0).hidden);
  }
}

TEST(AnimationPointers, IntegersThatAreNotNormalisedAreNumbers) {
  AnimatedFile file = lit_triangle();
  file.move("/extensions/KHR_lights_punctual/lights/0/intensity",
            {file.seconds({0, 1}),
             file.accessor(std::vector<std::uint16_t>{100, 300}, kUnsignedShort, "SCALAR", 2)});
  EXPECT_EQ(file.at(0.5).lights.at(0).intensity.x(), 200.0f);
}

TEST(AnimationPointers, ValuesOutOfRangeAreClamped) {
  AnimatedFile file = lit_triangle();
  const int times = file.seconds({0, 1});
  file.move("/cameras/0/perspective/yfov", {times, file.scalars({-1, 4})});
  file.move("/cameras/0/perspective/aspectRatio", {times, file.scalars({-1, 1})});
  file.move("/extensions/KHR_lights_punctual/lights/0/range", {times, file.scalars({-1, 1})});
  file.move("/extensions/KHR_lights_punctual/lights/0/intensity", {times, file.scalars({-1, 1})});
  const Scene scene = file.at(0.0);
  EXPECT_EQ(scene.cameras[0].vertical_fov, 1e-6f);
  EXPECT_EQ(scene.cameras[0].aspect, 0.0f) << "that of the picture";
  EXPECT_EQ(scene.lights[0].range, kInfinity);
  EXPECT_EQ(scene.lights[0].intensity.x(), 0.0f);
  expect_messages(
      scene.warnings,
      {{"/cameras/0/perspective/yfov", "-1", "clamped"}, {"aspectRatio"}, {"range"}, {"intensity"}});
  EXPECT_EQ(file.at(1.0).cameras[0].vertical_fov, 3.141592f);
}

TEST(AnimationPointers, ToOtherPlacesAreIgnoredWithAWarning) {
  for (const std::string& pointer : tests::words_of(
           "/materials/0/extensions/KHR_materials_ior/ior /materials/9/alphaCutoff "
           "/materials/0/doubleSided /materials/0/name /materials/0/pbrMetallicRoughness "
           "/materials/0/occlusionTexture/strength /materials/x/alphaCutoff "
           "/materials/0/emissiveTexture/extensions/KHR_texture_transform/rotation /materials "
           "/materials/ /cameras/0/perspective/zfar /cameras/0/perspective/yfov/0 /nodes/0/matrix "
           "/nodes/0/weights /nodes/0/weights/0 /nodes/0/weights/0/0 /nodes/0/extras/speed "
           "/accessors/0/count /scene /extensions/KHR_lights_punctual/lights/4/intensity "
           "/extensions/EXT_lights_image_based/lights/0/intensity "
           "/extensions/KHR_lights_punctual/lights /extensions // / materials /meshes/0/weights")) {
    AnimatedFile file = lit_triangle();
    file.move(pointer, {file.seconds({0, 1}), file.scalars({0, 1})});
    const Scene scene = file.at(0.5);
    ASSERT_EQ(scene.warnings.size(), 1u) << pointer;
    EXPECT_TRUE(tests::has_name(scene.warnings[0], pointer)) << scene.warnings[0];
  }
  AnimatedFile several = lit_triangle();
  for (int k = 0; k < 3; ++k)
    several.move("/materials/0/extras/a" + std::to_string(k), {several.seconds({0}), several.scalars({0})});
  expect_messages(several.at(0.0).warnings,
                  {{"animations[0].channels[0]", "/materials/0/extras/a0", "2 more"}});
}

TEST(AnimationPointers, EnvironmentsOfTheFile) {
  AnimatedFile file = textured_triangle();
  file.root["extensionsUsed"].push_back("EXT_lights_image_based");
  const json faces = json::array({0, 0, 0, 0, 0, 0});
  file.root["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 9.0}, {"specularImages", {faces}}}, {{"intensity", 7.0}, {"specularImages", {faces}}}};
  file.root["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
  file.move("/extensions/EXT_lights_image_based/lights/1/intensity",
            {file.seconds({0, 1}), file.scalars({2, 4})});
  EXPECT_EQ(file.at(0.5).image_light->intensity, 3.0f);
}

}  // namespace
}  // namespace gatelight::scene
