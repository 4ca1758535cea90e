// --visibility and --light-links through the real program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class VisibilityFlags : public FolderTest {
 protected:
  /// The tiny scene, whose square is named "wall" and glows as "panel", with another one, "hero", and a sun,
  /// "noon".
  static json lit() {
    json file = json::parse(tiny_scene());
    add_light(file, {{"type", "directional"}, {"name", "noon"}});
    file["materials"][0]["name"] = "panel";
    file["materials"][0]["emissiveFactor"] = {0.25, 0.25, 0.25};
    file["nodes"][0]["name"] = "wall";
    file["scenes"][0]["nodes"].push_back(file["nodes"].size());
    file["nodes"].push_back({{"name", "hero"}, {"mesh", 0}, {"translation", {9, 0, 0}}});
    return file;
  }

  static Output info(const std::string& file, const Words& more = {}) {
    return run_gatelight_inside(words_of("info {}", {file}, more));
  }
  static json json_of(const std::string& file, const Words& more = {}) {
    return json::parse(expect_done(info(file, words_of("--json -", {}, more))).out);
  }

  std::string scene = folder.write("lit.gltf", lit().dump());
};

const Words kVisibility = {"--visibility",
                           "wall=camera:off,shadow:off;hero=shadow:only,holdout:on;noon=glossy:off;"
                           "environment=camera:off"};

TEST_F(VisibilityFlags, InfoSaysWhatDiffers) {
  const Output output = expect_done(info(scene, kVisibility));
  EXPECT_THAT(output.out, HasSubstr("\nvisibility     'wall' without camera, shadow\n"));
  EXPECT_THAT(output.out, HasSubstr("\n               'hero' only shadow; holdout\n"));
  EXPECT_THAT(output.out, HasSubstr("\n               light 'noon' without glossy\n"));
  EXPECT_THAT(output.out, HasSubstr("\n               environment without camera\n"));
  EXPECT_THAT(output.out, Not(HasSubstr("light links")));
  EXPECT_EQ(json_of(scene, kVisibility)["visibility"], json::parse(R"([
    {"kind": "object", "name": "wall", "rays": ["diffuse", "glossy", "transmission", "volume"]},
    {"kind": "object", "name": "hero", "rays": ["shadow"], "holdout": true},
    {"kind": "light", "name": "noon", "rays": ["diffuse", "transmission", "volume"]},
    {"kind": "environment", "rays": ["diffuse", "glossy", "transmission", "volume"]}])"));
  EXPECT_THAT(expect_done(info(scene)).out, Not(HasSubstr("visibility")));
  EXPECT_EQ(json_of(scene)["visibility"], json::array());
}

TEST_F(VisibilityFlags, InfoSaysWhomLightsConcern) {
  const Words links = {"--light-links",
                       "noon=receivers:wall,blockers:*;panel=not-blockers:hero;environment=blockers:wall"};
  const Output output = expect_done(info(scene, links));
  EXPECT_THAT(
      output.out,
      HasSubstr("\nlight links    light 'noon' lights only 'wall'; is blocked by only 'hero', 'wall'\n"));
  EXPECT_THAT(output.out, HasSubstr("\n               material 'panel' is blocked by all but 'hero'\n"));
  EXPECT_THAT(output.out, HasSubstr("\n               environment is blocked by only 'wall'\n"));
  EXPECT_EQ(json_of(scene, links)["light_links"], json::parse(R"([
    {"kind": "light", "name": "noon", "receivers": {"only": ["wall"]}, "blockers": {"only": ["hero", "wall"]}},
    {"kind": "material", "name": "panel", "blockers": {"all_but": ["hero"]}},
    {"kind": "environment", "blockers": {"only": ["wall"]}}])"));
  EXPECT_EQ(json_of(scene)["light_links"], json::array());
}

TEST_F(VisibilityFlags, InfoCutsLongLists) {
  json file = lit();
  for (int i = 0; i < 30; ++i) {
    file["scenes"][0]["nodes"].push_back(file["nodes"].size());
    file["nodes"].push_back(
        {{"name", "x" + std::to_string(10 + i)}, {"mesh", 0}, {"translation", {0, 0, -i}}});
  }
  const std::string many = folder.write("many.gltf", file.dump());
  const Output output =
      expect_done(info(many, {"--visibility", "x*=camera:off", "--light-links", "noon=receivers:x*"}));
  EXPECT_THAT(output.out, HasSubstr("'x29' without camera\n               ...\n"));
  EXPECT_THAT(output.out, HasSubstr("'x17', and 22 more\n"));
}

TEST_F(VisibilityFlags, AreInTheRecipe) {
  const std::string file = path("a.exr");
  const auto options_of = [&](const Words& flags) {
    expect_done(
        run_gatelight_inside(words_of("render {} -o {} --size 8x4 --spp 1 --quiet", {scene, file}, flags)));
    return json::parse(renderer::read_image(file).metadata.at("options"));
  };
  const json options = options_of(
      {"--visibility", "w*=reflections:off", "--light-links", "noon=receivers:wall+hero,blockers:hero"});
  EXPECT_EQ(options["visibility"], "w*=diffuse:off,glossy:off");
  EXPECT_EQ(options["light-links"], "noon=receivers:wall+hero,blockers:hero");
  const json plain = options_of({});
  EXPECT_FALSE(plain.contains("visibility") || plain.contains("light-links"));
}

TEST_F(VisibilityFlags, UnknownNamesAreRefused) {
  expect_failure(info(scene, {"--visibility", "wal=camera:off"}), 2,
                 {"lit.gltf", "visibility", "'wal'", "'hero'", "did you mean 'wall'"});
  expect_failure(info(scene, {"--visibility", "wall=camera:off,bounces:off,shadow:off"}), 2,
                 {"'wall'", "no ray"});
  expect_failure(info(scene, {"--light-links", "non=receivers:wall"}), 2, {"light-links", "'non'", "'noon'"});
  expect_failure(info(scene, {"--light-links", "noon=receivers:wall+x*"}), 2, {"'x*'", "'hero'"});
  expect_failure(info(scene, {"--light-links", "noon=not-receivers:*"}), 2, {"'noon'", "no object"});
}

}  // namespace
}  // namespace gatelight::tests
