// --lights, --light-groups and --sky through the real program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "tests/support/denoiser.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using renderer::Picture;
using renderer::read_image;

/// The tiny scene with a sun named "noon" that falls onto the square, whose material "panel" glows.
std::string lit_scene() {
  json scene = json::parse(tiny_scene());
  add_light(scene, {{"type", "directional"}, {"name", "noon"}});
  scene["materials"][0]["name"] = "panel";
  scene["materials"][0]["emissiveFactor"] = {0.25, 0.25, 0.25};
  return scene.dump();
}

class LightFlags : public FolderTest {
 protected:
  Picture render(const Words& flags) const {
    const std::string file = (folder / "a.exr").string();
    Words arguments = {"render", scene, "-o", file, "--exr", "float", "--size", "24x16", "--spp", "4"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    expect_done(run_gatelight(arguments));
    return read_image(file);
  }

  std::string scene = folder.write("lit.gltf", lit_scene());
};

float middle(const Picture& picture) {
  return picture.layers[0].values[3 * (8 * 24 + 12)];
}

TEST_F(LightFlags, ScaleAndSwitchOffAndAreInTheRecipe) {
  const Picture plain = render({});
  const Picture twice = render({"--lights", "noon=2;panel=2"});
  EXPECT_GT(middle(plain), 0.3f);
  const std::vector<float>&once = plain.layers[0].values, &doubled = twice.layers[0].values;
  for (std::size_t i = 0; i < once.size(); ++i) ASSERT_EQ(2.0f * once[i], doubled[i]) << i;
  const Picture dark = render({"--lights", "*=off"});
  for (const float value : dark.layers[0].values) ASSERT_EQ(value, 0.0f);
  EXPECT_FLOAT_EQ(middle(render({"--lights", "*=off;panel=4"})), 1.0f);
  EXPECT_EQ(json::parse(twice.metadata.at("options"))["lights"], "noon=2;panel=2");
  EXPECT_FALSE(json::parse(plain.metadata.at("options")).contains("lights"));
}

TEST_F(LightFlags, IesProfilesShapeALightAndAreInTheRecipe) {
  json lit = json::parse(lit_scene());
  lit["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "lamp"}}};
  lit["nodes"].back()["translation"] = {0.0, 0.0, 1.0};
  scene = folder.write("lamp.gltf", lit.dump());
  const auto profile = [&](const char* candela) {
    return folder.write(std::string("a") + candela + ".ies",
                        std::string("TILT=NONE\n1 -1 1 3 1 1 2 0 0 0 1 1 1  0 90 180  0 ") + candela);
  };
  const std::string down = profile("8 8 8"), up = profile("0 0 8"), half = profile("4 8 8");
  const std::string off = "panel=off";
  const float plain = middle(render({"--lights", off}));
  EXPECT_GT(plain, 0.01f);
  EXPECT_NEAR(middle(render({"--lights", off, "--ies", "lamp=" + down})), plain, 1e-5f * plain);
  EXPECT_LT(middle(render({"--lights", off, "--ies", "lamp=" + half})), 0.95f * plain);
  const Picture none = render({"--lights", off, "--ies", "l*=" + up});
  EXPECT_LT(middle(none), 0.01f * plain);
  EXPECT_EQ(json::parse(none.metadata.at("options"))["ies"], "l*=" + up);
  expect_failure(run_gatelight_inside({"render", scene, "-o", path("b.png"), "--ies", "lamp"}), 1,
                 {"--ies", "'lamp'", "NAME=FILE"});
}

TEST_F(LightFlags, InfoNamesTheLightsThatTheyCanChange) {
  const Output output = expect_done(run_gatelight({"info", scene, "--lights", "noon=3;panel=0,4,0"}));
  EXPECT_THAT(output.out, ::testing::HasSubstr("directional 'noon', intensity 3 3 3"));
  EXPECT_THAT(output.out, ::testing::HasSubstr("material 'panel', emission 0 1 0"));
  const json description = json::parse(run_gatelight({"info", scene, "--json", "-"}).out);
  EXPECT_EQ(description["lights"][0]["intensity"], (json{1.0, 1.0, 1.0}));
  EXPECT_EQ(description["emissive_materials"][0]["name"], "panel");
}

/// The middle pixel of a layer.
float middle_of(const Picture& picture, const std::string& layer) {
  const renderer::Layer* const found = picture.find(layer);
  EXPECT_NE(found, nullptr) << layer;
  return found ? found->values[3 * (8 * 24 + 12)] : 0.0f;
}

TEST_F(LightFlags, GroupsAreLayersThatAddUpAndAreInTheRecipe) {
  const Words flags = {"--light-groups", "key=no*;sky=environment", "--environment", "0.25,0.25,0.25"};
  const Picture picture = render(flags);
  ASSERT_EQ(picture.layers.size(), 4u);
  EXPECT_FLOAT_EQ(middle_of(picture, "light-rest"), 0.25f);
  const auto share = [&](const char* layer) { return middle_of(picture, layer); };
  EXPECT_GT(share("light-key"), 0.1f);
  EXPECT_GT(share("light-sky"), 0.01f);
  EXPECT_NEAR(share("light-key") + share("light-sky") + share("light-rest"), middle(picture), 1e-6f);
  EXPECT_EQ(json::parse(picture.metadata.at("options"))["light-groups"], "key=no*;sky=environment");
  const Output command = run_gatelight({"info", (folder / "a.exr").string(), "--command"});
  EXPECT_THAT(command.out, ::testing::HasSubstr("--light-groups 'key=no*;sky=environment'"));
  EXPECT_FALSE(json::parse(render({}).metadata.at("options")).contains("light-groups"));
  // With --lights: a light that is switched off is black.
  const Picture dark = render({"--light-groups", "panel=panel;key=noon", "--lights", "panel=off;noon=2"});
  ASSERT_EQ(dark.layers.size(), 3u);
  EXPECT_EQ(middle_of(dark, "light-panel"), 0.0f);
  EXPECT_FLOAT_EQ(middle_of(dark, "light-key"), middle(dark));
}

TEST_F(LightFlags, ASkyLightsASceneWithoutLightsAndIsInTheRecipe) {
  const std::string dark = folder.write("dark.gltf", tiny_scene());
  const std::string file = (folder / "sky.exr").string();
  const Output output = expect_done(run_gatelight(
      {"render", dark, "-o", file, "--size", "24x16", "--spp", "16", "--sky", "sun=180,30, turbidity=2"}));
  EXPECT_EQ(output.err.find("soft sky"), std::string::npos) << output.err;
  const Picture picture = read_image(file);
  EXPECT_GT(middle(picture), 0.1f);  // the sun is in the south, behind the camera
  EXPECT_LT(middle(picture), 1.5f);
  EXPECT_EQ(json::parse(picture.metadata.at("options"))["sky"],
            "turbidity=2,sun=180,30,ground=0.2,size=0.53,intensity=1");
}

}  // namespace
}  // namespace gatelight::tests
