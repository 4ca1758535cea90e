// The output of `gatelight info` for scenes and rendered pictures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/image/image_write.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class InfoCommand : public FolderTest {
 protected:
  static Output info(const std::string& file, const Words& more = {}) {
    return run_gatelight_inside(words_of("info {}", {file}, more));
  }
  static json json_of(const std::string& file) {
    return json::parse(expect_done(info(file, {"--json", "-"})).out);
  }

  /// A light of each type and a camera of each type, three metres along x.
  std::string lit_scene() const {
    json file = json::parse(tiny_scene());
    const auto light = [&](const char* name, const char* type, json more) {
      json one = {{"name", name}, {"type", type}, {"color", {1.0, 0.5, 0.25}}, {"intensity", 8.0}};
      one.update(more);
      add_light(file, one, {{"translation", {3, 0, 1}}});
    };
    light("lamp", "point", {{"range", 12.5}});
    light("torch", "spot", {{"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
    light("sun", "directional", json::object());
    file["cameras"].push_back(
        {{"name", "plan"},
         {"type", "orthographic"},
         {"orthographic", {{"xmag", 2.0}, {"ymag", 1.5}, {"znear", 0.1}, {"zfar", 9.0}}}});
    file["nodes"].push_back({{"name", "above"}, {"camera", 1}, {"translation", {3, 4, 5}}});
    file["scenes"][0]["nodes"].push_back(file["nodes"].size() - 1);
    return folder.write("lit.gltf", file.dump());
  }

  /// A render of the tiny scene into a file whose name needs quotes.
  std::string rendered(const Words& more = {}) const {
    const std::string scene = folder.write("it's a scene.gltf", tiny_scene());
    Words call = words_of("render {} -o {} --size 8x4 --spp 2 --environment 1,1,1 --aov depth --quiet",
                          {scene, path("a b.exr")}, more);
    expect_done(run_gatelight(call));
    return path("a b.exr");
  }
};

TEST_F(InfoCommand, ReportsWhichOfOverlappingBodiesFillsTheSpace) {
  const std::string scene = std::string(GATELIGHT_SOURCE_DIR) + "/data/iced-water.glb";
  const json media = json_of(scene)["nested_media"];
  std::vector<std::string> names;
  for (const json& medium : media) names.push_back(medium["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"glass", "bubble 0", "bubble 1", "bubble 2", "ice 0", "ice 1",
                                             "ice 2", "water"}));
  EXPECT_EQ(media[0]["priority"], 1.0);
  EXPECT_EQ(media[7]["ior"], 1.333);
  EXPECT_THAT(info(scene).out, AllOf(HasSubstr("nested media"), HasSubstr("'ice 1', ior 1.31")));
  EXPECT_EQ(json_of(lit_scene())["nested_media"], json::array());
}

TEST_F(InfoCommand, JsonHasLightsWithTheirUnitsAndPlaces) {
  const json description = json_of(lit_scene());
  const json& lights = description["lights"];
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights[0]["name"], "lamp");
  EXPECT_EQ(lights[0]["intensity"], json({8.0, 4.0, 2.0}));
  EXPECT_EQ(lights[0]["unit"], "W/sr");
  EXPECT_EQ(lights[0]["position"], json({3.0, 0.0, 1.0}));
  EXPECT_EQ(lights[0]["range"], 12.5);
  EXPECT_FALSE(lights[0].contains("direction"));
  EXPECT_EQ(lights[1]["direction"], json({0.0, 0.0, -1.0}));
  EXPECT_TRUE(lights[1]["range"].is_null());
  EXPECT_NEAR(lights[1]["inner_cone_degrees"].get<double>(), 14.3239, 1e-3);
  EXPECT_NEAR(lights[1]["outer_cone_degrees"].get<double>(), 28.6479, 1e-3);
  EXPECT_EQ(lights[2]["unit"], "W/m2");
  EXPECT_FALSE(lights[2].contains("position"));
  EXPECT_FALSE(lights[2].contains("range"));
}

TEST_F(InfoCommand, JsonHasCamerasWithTheirTransforms) {
  const json description = json_of(lit_scene());
  const json& cameras = description["cameras"];
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_NEAR(cameras[0]["vertical_fov_degrees"].get<double>(), 51.5662, 1e-3);
  EXPECT_EQ(cameras[0]["node"], "front");
  EXPECT_EQ(cameras[1]["name"], "plan");
  EXPECT_EQ(cameras[1]["node"], "above");
  EXPECT_EQ(cameras[1]["type"], "orthographic");
  EXPECT_EQ(cameras[1]["height"], 3.0);
  EXPECT_EQ(cameras[1]["width"], 4.0);
  EXPECT_EQ(cameras[1]["transform"],
            json({1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0, 4.0, 5.0, 1.0}))
      << "column after column";
}

TEST_F(InfoCommand, AnimationsHaveNamesAndLengths) {
  const std::string figure = GATELIGHT_SOURCE_DIR "/data/figure.glb";
  EXPECT_THAT(info(figure).out, HasSubstr("0 'walk', 1 s\n"));
  const json description = json_of(figure);
  EXPECT_EQ(description["animations"], json::parse(R"([{"name": "walk", "seconds": 1.0}])"));
  EXPECT_TRUE(json_of(lit_scene())["animations"].empty());
}

TEST_F(InfoCommand, APictureShowsItsRecipe) {
  const std::string picture = rendered({"--region", "2,1,6,3"});
  const Output text = expect_done(info(picture));
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\nsize +4 x 2 at 2, 1 of 8 x 4\n"));
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\nlayers +beauty [(]R,G,B[)]\n +depth [(]Z[)]\n"));
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\nspp +2\n"));
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\n--environment +1,1,1\n"));
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\n--aov +depth\n"));
  EXPECT_THAT(text.out, ::testing::ContainsRegex("\n--size +8x4\n"));
  EXPECT_THAT(text.out, Not(HasSubstr("--variant"))) << "it has no value";
  const json description = json_of(picture);
  EXPECT_EQ(description["width"], 4);
  EXPECT_EQ(description["full_width"], 8);
  EXPECT_EQ(description["layers"][1]["name"], "depth");
  EXPECT_EQ(description["recipe"]["spp"], 2);
  EXPECT_EQ(description["recipe"]["options"]["size"], json({8, 4}));
  EXPECT_EQ(description["recipe"]["scene"], path("it's a scene.gltf"));
}

TEST_F(InfoCommand, TheCommandOfAPictureReproducesIt) {
  const std::string picture = rendered();
  const Output description = expect_done(info(picture, {"--command"}));
  EXPECT_EQ(std::count(description.out.begin(), description.out.end(), '\n'), 1);
  EXPECT_THAT(description.out, HasSubstr(R"(it'\''s a scene.gltf')"));
  const std::string before = read_file(picture);
  std::filesystem::remove(picture);
  ASSERT_EQ(std::system(description.out.c_str()), 0) << description.out;
  EXPECT_EQ(read_file(picture).size(), before.size());
}

TEST_F(InfoCommand, APictureWithoutARecipeIsRefused) {
  renderer::Picture plain{
      .width = 1, .height = 1, .layers = {{.name = "", .channels = {"R", "G", "B"}, .values = {1, 1, 1}}}};
  renderer::write_image(plain, path("plain.exr"), {});
  expect_failure(info(path("plain.exr")), 2, {path("plain.exr"), "recipe"});
  expect_failure(info(path("plain.png")), 2, {path("plain.png"), "recipe"});
  expect_failure(info(path("none.exr")), 2, {path("none.exr")});
  const std::string silent = rendered({"--reproducible"});
  expect_failure(info(silent, {"--command"}), 2, {silent, "--reproducible"});
  expect_done(info(silent));
}

TEST_F(InfoCommand, FlagsOfPicturesAreRefusedForScenesAndViceVersa) {
  const std::string scene = folder.write("scene.gltf", tiny_scene());
  expect_failure(info(scene, {"--command"}), 1, {"--command", "PICTURE.exr"});
  expect_failure(info("--command"), 1, {"--command", "PICTURE.exr"});
  expect_failure(info(path("a.exr"), {"--camera", "front"}), 1, {"--camera", path("a.exr")});
}

}  // namespace
}  // namespace gatelight::tests
