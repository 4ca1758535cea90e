// Lights of a loaded scene switched off, multiplied and coloured; photometric files of the IES on them.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "scene/ies_profile.h"
#include "scene/light_adjustments.h"
#include "scene/light_profiles.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::scene {
namespace {

using tests::expect_refusal;

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

/// Returns a file with these angles and candela, plane after plane.
std::string web(const std::vector<double>& vertical, const std::vector<double>& horizontal,
                const std::vector<double>& candela, const std::string& factors = "1 1 1") {
  return fmt::format(
      "IESNA:LM-63-2002\r\n[TEST] a luminaire\r\nTILT=NONE\r\n1 -1 1 {} {} 1 2 0 0 0\r\n{} "
      "\r\n{}\r\n{}\r\n{}\r\n",
      vertical.size(), horizontal.size(), factors, fmt::join(vertical, " "), fmt::join(horizontal, ","),
      fmt::join(candela, " "));
}

/// Returns a direction from the angles of the file, in degrees.
Vec3 direction(double vertical, double horizontal) {
  const double v = vertical * M_PI / 180.0, h = horizontal * M_PI / 180.0;
  return Eigen::Vector3d(std::sin(v) * std::cos(h), std::sin(v) * std::sin(h), -std::cos(v)).cast<float>();
}

TEST(IesProfile, ADownlightIsTheSameAllAroundAndDarkAboveItsLastAngle) {
  const IesProfile profile(web({0, 45, 90}, {0}, {100, 50, 20}));
  EXPECT_EQ(profile.greatest(), 100.0);
  EXPECT_EQ(profile.values().size(), 721u);
  for (const double around : {0.0, 77.0, 180.0, 271.0}) {
    EXPECT_NEAR(profile.relative(direction(0, around)), 1.0f, 1e-6f);
    EXPECT_NEAR(profile.relative(direction(18, around)), 0.8f, 1e-5f);
    EXPECT_NEAR(profile.relative(direction(60, around)), 0.4f, 1e-5f);
    EXPECT_EQ(profile.relative(direction(91, around)), 0.0f);
    EXPECT_EQ(profile.relative(direction(180, around)), 0.0f);
  }
  EXPECT_NEAR(profile.relative(3.0f * direction(45, 10)), 0.5f, 1e-5f);
  EXPECT_NEAR(profile.extent(), 90.25 * M_PI / 180.0, 1e-5);
}

TEST(IesProfile, TheLastHorizontalAngleSetsTheSymmetry) {
  const auto all_around = [](const std::vector<double>& horizontal, const std::vector<double>& at_90) {
    std::vector<double> candela;
    for (const double value : at_90) candela.insert(candela.end(), {value, value});
    const IesProfile profile(web({0, 180}, horizontal, candela));
    std::vector<double> values;
    for (double around = 0.0; around < 360.0; around += 45.0)
      values.push_back(
          std::round(profile.greatest() * static_cast<double>(profile.relative(direction(90, around)))));
    return values;
  };
  using Values = std::vector<double>;
  EXPECT_EQ(all_around({0, 90}, {10, 30}), (Values{10, 20, 30, 20, 10, 20, 30, 20}));
  EXPECT_EQ(all_around({0, 90, 180}, {10, 30, 50}), (Values{10, 20, 30, 40, 50, 40, 30, 20}));
  EXPECT_EQ(all_around({90, 180, 270}, {10, 30, 50}), (Values{30, 20, 10, 20, 30, 40, 50, 40}));
  EXPECT_EQ(all_around({0, 90, 180, 270, 360}, {10, 30, 50, 70, 10}),
            (Values{10, 20, 30, 40, 50, 60, 70, 40}));
  EXPECT_EQ(all_around({0, 90, 180, 270}, {10, 30, 50, 70}), (Values{10, 20, 30, 40, 50, 60, 70, 40}));
}

TEST(IesProfile, FactorsMultiplyAndTiltIsSkipped) {
  EXPECT_DOUBLE_EQ(IesProfile(web({0, 90}, {0}, {10, 40}, "0.5 3 25")).greatest(), 60.0);
  std::string text = web({0, 90}, {0}, {10, 40});
  const std::string tilt = "TILT=NONE";
  text.replace(text.find(tilt), tilt.size(), "TILT=INCLUDE\n1\n3\n0 45 90\n1.0 .95 +.8");
  EXPECT_EQ(IesProfile(text).greatest(), 40.0);
}

TEST(IesProfile, BrokenFilesAreRefusedByTheirValue) {
  const auto refuse = [](const std::string& text, const tests::NameList& names) {
    expect_refusal<InputError>([&] { IesProfile profile(text); }, names);
  };
  const std::string good = web({0, 90}, {0}, {10, 40});
  const auto with = [&](const std::string& part, const std::string& other) {
    std::string text = good;
    return text.replace(text.find(part), part.size(), other);
  };
  refuse("", {"TILT="});
  refuse("\x89PNG\r\n", {"TILT="});
  refuse(good.substr(0, good.size() - 6), {"ends", "candela"});
  refuse(with("10 40", "10 x40"), {"x40", "number"});
  refuse(with("10 40", "10 nan"), {"nan", "number"});
  refuse(with("10 40", "10 -4"), {"-4"});
  refuse(with("10 40", "0 0"), {"0", "light"});
  refuse(with("1 2 0 0 0", "2 2 0 0 0"), {"2", "type C"});
  refuse(with("0 90\r", "0 190\r"), {"190", "180"});
  refuse(with("0 90\r", "90 0\r"), {"90", "0"});
  refuse(with("1 -1 1 2 1", "1 -1 1 2.5 1"), {"2.5"});
  refuse(with("1 -1 1 2 1", "1 -1 1 1e9 1"), {"10000"});
  refuse(with("1 1 1 \r", "0 1 1 \r"), {"0"});
  refuse(web({0, 90}, {0, 45}, {1, 2, 3, 4}), {"0", "45"});
}

Scene scene_with_lights() {
  Scene scene;
  scene.path = "lit.glb";
  for (const auto& [name, type] : {std::pair("lamp left", LightType::spot),
                                   {"lamp right", LightType::point},
                                   {"sun", LightType::directional}})
    scene.lights.push_back({.name = name, .type = type});
  return scene;
}

TEST(LightProfiles, AreAssignedByNameAndMakePointLights) {
  const tests::TemporaryFolder folder;
  const std::string down = folder.write("down.ies", web({0, 90}, {0}, {10, 40}));
  const std::string up = folder.write("up.ies", web({90, 180}, {0}, {10, 70}));
  Scene scene = scene_with_lights();
  give_profiles(scene, {{"*", down}, {"lamp right", up}});
  ASSERT_TRUE(scene.lights[0].profile && scene.lights[1].profile);
  EXPECT_EQ(scene.lights[0].profile->greatest(), 40.0);
  EXPECT_EQ(scene.lights[1].profile->greatest(), 70.0);
  EXPECT_EQ(scene.lights[0].type, LightType::point);
  EXPECT_FALSE(scene.lights[2].profile);
}

TEST(LightProfiles, UnknownLightsAndFilesAreRefused) {
  const tests::TemporaryFolder folder;
  const std::string good = folder.write("good.ies", web({0, 90}, {0}, {10, 40}));
  const std::string bad = folder.write("bad.ies", "TILT=NONE 1 2");
  Scene scene = scene_with_lights();
  const auto refuse = [&](const LightProfile& profile, const tests::NameList& names) {
    expect_refusal<InputError>([&] { give_profiles(scene, {profile}); }, names);
  };
  refuse({"moon", good}, {"lit.glb", "'moon'", "'lamp left'", "'lamp right'"});
  refuse({"sun", good}, {"lit.glb", "'sun'"});
  refuse({"lamp left", bad}, {bad});
  refuse({"lamp left", (folder / "none.ies").string()}, {"none.ies"});
}

}  // namespace
}  // namespace gatelight::scene
