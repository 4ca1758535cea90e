// --lights and --sky through the real program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using renderer::Picture;
using renderer::read_image;

/// The tiny scene with a sun named "noon" that falls onto the square, whose material "panel" glows.
std::string lit_scene() {
  json scene = json::parse(tiny_scene());
  scene["extensionsUsed"] = {"KHR_lights_punctual"};
  scene["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"name", "noon"}}};
  scene["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  scene["scenes"][0]["nodes"].push_back(2);
  scene["materials"][0]["name"] = "panel";
  scene["materials"][0]["emissiveFactor"] = {0.25, 0.25, 0.25};
  return scene.dump();
}

class LightFlags : public ::testing::Test {
 protected:
  Picture render(const std::vector<std::string>& flags) const {
    const std::string file = (folder / "a.exr").string();
    std::vector<std::string> arguments = {"render", scene,    "-o",    file,    "--exr",
                                          "float",  "--size", "24x16", "--spp", "4"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Output output = run_gatelight(arguments);
    EXPECT_EQ(output.exit_code, 0) << output.err;
    return read_image(file);
  }

  TemporaryFolder folder;
  std::string scene = folder.write("lit.gltf", lit_scene());
};

float middle(const Picture& picture) {
  return picture.layers[0].values[3 * (8 * 24 + 12)];
}

TEST_F(LightFlags, ScaleAndSwitchOffAndAreInTheRecipe) {
  const Picture plain = render({});
  const Picture twice = render({"--lights", "noon=2;panel=2"});
  EXPECT_GT(middle(plain), 0.3f);
  EXPECT_EQ(middle(twice), 2.0f * middle(plain));
  EXPECT_EQ(middle(render({"--lights", "*=off"})), 0.0f);
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
                        std::string("TILT=NONE 1 -1 1 3 1 1 2 0 0 0 1 1 1  0 90 180  0 ") + candela);
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
  const Output wrong = run_gatelight({"render", scene, "-o", (folder / "b.png").string(), "--ies", "lamp"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, ::testing::HasSubstr("--ies: 'lamp' is not NAME=FILE"));
}

TEST_F(LightFlags, InfoNamesWhatTheyCanChange) {
  const Output output = run_gatelight({"info", scene, "--lights", "noon=3;panel=0,4,0"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_THAT(output.out, ::testing::HasSubstr("directional 'noon', intensity 3 3 3"));
  EXPECT_THAT(output.out, ::testing::HasSubstr("material 'panel', emission 0 1 0"));
  const json told = json::parse(run_gatelight({"info", scene, "--json", "-"}).out);
  EXPECT_EQ(told["lights"][0]["intensity"], (json{1.0, 1.0, 1.0}));
  EXPECT_EQ(told["emissive_materials"][0]["name"], "panel");
}

TEST_F(LightFlags, ASkyIsTheLightOfASceneWithoutAndInTheRecipe) {
  const std::string dark = folder.write("dark.gltf", tiny_scene());
  const std::string file = (folder / "sky.exr").string();
  const Output output = run_gatelight(
      {"render", dark, "-o", file, "--size", "24x16", "--spp", "16", "--sky", "sun=180,30, turbidity=2"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(output.err.find("soft sky"), std::string::npos) << output.err;
  const Picture picture = read_image(file);
  EXPECT_GT(middle(picture), 0.1f);  // the sun is in the south, behind the camera
  EXPECT_LT(middle(picture), 1.5f);
  EXPECT_EQ(json::parse(picture.metadata.at("options"))["sky"],
            "turbidity=2,sun=180,30,ground=0.2,size=0.53,intensity=1");
}

}  // namespace
}  // namespace gatelight::tests
