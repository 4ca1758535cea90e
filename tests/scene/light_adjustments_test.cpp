// Lights of a loaded scene switched off, multiplied and coloured.

#include "scene/light_adjustments.h"

#include <gtest/gtest.h>

#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

Scene lit_scene() {
  Scene scene;
  scene.path = "lit.glb";
  for (const char* name : {"lamp left", "lamp right", "sun"})
    scene.lights.push_back({.name = name, .intensity = Color(1.0f, 2.0f, 4.0f)});
  for (const char* name : {"screen", "lamp shade", "wall"}) {
    Material material;
    material.name = name;
    if (material.name != "wall") material.emission = Color(3.0f, 3.0f, 3.0f);
    scene.materials.push_back(material);
  }
  return scene;
}

bool same(const Color& a, const Color& b) {
  return (a == b).all();
}

TEST(LightAdjustments, NamesSelectLightsAndEmissiveMaterials) {
  Scene scene = lit_scene();
  adjust_lights(scene, {{"sun", Color(0.5f, 1.0f, 2.0f)}, {"screen", Color::Zero()}});
  EXPECT_TRUE(same(scene.lights[2].intensity, Color(0.5f, 2.0f, 8.0f)));
  EXPECT_TRUE(same(scene.lights[0].intensity, Color(1.0f, 2.0f, 4.0f)));
  EXPECT_FALSE(scene.materials[0].emits());
  EXPECT_EQ(scene.dark_lights, std::vector<std::string>{"screen"});
  EXPECT_TRUE(same(scene.materials[1].emission, Color(3.0f, 3.0f, 3.0f)));
}

TEST(LightAdjustments, AStarMatchesAnyEndingAndTheLastMatchCounts) {
  Scene scene = lit_scene();
  adjust_lights(scene,
                {{"*", Color::Zero()}, {"lamp*", Color::Constant(2.0f)}, {"lamp right", Color::Ones()}});
  EXPECT_TRUE(same(scene.lights[0].intensity, Color(2.0f, 4.0f, 8.0f)));
  EXPECT_TRUE(same(scene.lights[1].intensity, Color(1.0f, 2.0f, 4.0f)));
  EXPECT_TRUE(same(scene.lights[2].intensity, Color::Zero()));
  EXPECT_TRUE(same(scene.materials[0].emission, Color::Zero()));
  EXPECT_TRUE(same(scene.materials[1].emission, Color::Constant(6.0f)));
}

TEST(LightAdjustments, UnknownNamesAreRefusedWithTheKnownOnes) {
  Scene scene = lit_scene();
  const auto refuse = [&](const std::string& name, const tests::NameList& names) {
    tests::expect_refusal<InputError>([&] { adjust_lights(scene, {{name, Color::Ones()}}); }, names);
  };
  refuse("moon", {"lit.glb", "'moon'", "'lamp left'", "'sun'", "'lamp shade'", "'screen'"});
  refuse("wall", {"lit.glb", "'wall'", "'sun'"});  // it does not emit
  refuse("lamp", {"'lamp'", "'lamp left'"});
  refuse("lamp rigth", {"'lamp rigth'", "did you mean 'lamp right'"});
  refuse("moon*", {"'moon*'"});
  Scene dark;
  dark.path = "dark.glb";
  tests::expect_refusal<InputError>(
      [&] {
        adjust_lights(dark, {{"*", Color::Ones()}});
      },
      {"dark.glb", "'*'", "none"});
  adjust_lights(dark, {});
}

TEST(LightAdjustments, ALongListIsCutAndAnInfiniteProductIsRefused) {
  Scene scene;
  for (int i = 0; i < 100; ++i) scene.lights.push_back({.name = "light " + std::to_string(100 + i)});
  tests::expect_refusal<InputError>(
      [&] {
        adjust_lights(scene, {{"x", Color::Ones()}});
      },
      {"'light 100'", "76"});
  scene.lights[0].intensity = Color::Constant(1e30f);
  tests::expect_refusal<InputError>(
      [&] {
        adjust_lights(scene, {{"*", Color(1.0f, 1e30f, 1.0f)}});
      },
      {"'light 100'", "1e+30", "finite"});
}

TEST(LightAdjustments, TheLoaderAppliesAdjustments) {
  GltfBuilder file;
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  set_lights(file, {{{"type", "point"}, {"name", "bulb"}, {"intensity", 8.0}}});
  file.node({{"extensions", light_of_node(0)}});
  const LoadOptions dimmed{.lights = {{"bulb", Color(0.5f, 1.0f, 0.0f)}}};
  EXPECT_TRUE(same(file.load(dimmed).lights.at(0).intensity, Color(4.0f, 8.0f, 0.0f)));
  file.expect_refused({"'tube'", "'bulb'"}, {.lights = {{"tube", Color::Ones()}}});
}

}  // namespace
}  // namespace gatelight::scene
