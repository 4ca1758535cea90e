// Cameras and views through the real program: --camera all, {camera} in names, --view-file.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;

class ViewFlags : public FolderTest {
 protected:
  /// The tiny scene with cameras of these names, each farther away than the one before.
  std::string scene_of(const std::vector<std::string>& names) {
    json scene = json::parse(tiny_scene());
    scene["cameras"] = json::array();
    scene["scenes"][0]["nodes"] = {0};
    for (std::size_t i = 0; i < names.size(); ++i) {
      scene["cameras"].push_back(
          {{"name", names[i]}, {"type", "perspective"}, {"perspective", {{"yfov", 0.6}, {"znear", 0.1}}}});
      scene["scenes"][0]["nodes"].push_back(scene["nodes"].size());
      scene["nodes"].push_back({{"camera", i}, {"translation", {0.0, 0.0, 2.0 + static_cast<double>(i)}}});
    }
    return folder.write("cameras.gltf", scene.dump());
  }
  Output render(const std::string& scene, const Words& flags) const {
    return run_gatelight(
        words_of("render {} --size 24x16 --spp 1 --exr float --reproducible", {scene}, flags));
  }
};

TEST_F(ViewFlags, CameraAllRendersEveryCameraWhateverItsName) {
  const std::string scene = scene_of({"2", "0", "twin", "twin"});
  expect_done(
      render(scene, {"--camera", "all", "-o", path("{camera}.exr"), "--stats", path("{camera}.json")}));
  expect_done(render(scene, {"--camera", "2", "-o", path("first.exr")}));
  EXPECT_EQ(beauty_of(path("2.exr")), beauty_of(path("first.exr")));
  expect_done(render(scene, {"--camera", "0", "-o", path("second.exr")}));
  EXPECT_EQ(beauty_of(path("0.exr")), beauty_of(path("second.exr")));
  EXPECT_NE(beauty_of(path("2.exr")), beauty_of(path("0.exr")));
  EXPECT_NE(beauty_of(path("twin-2.exr")), beauty_of(path("twin-3.exr")));
  EXPECT_TRUE(std::filesystem::exists(path("twin-3.json")));
}

TEST_F(ViewFlags, NamesOfCamerasNeverOverwriteAFile) {
  const auto refuse = [&](const std::vector<std::string>& names, const Words& flags, const std::string& of) {
    expect_failure(render(scene_of(names), flags), 1, {of});
  };
  const std::string out = path("{camera}.exr");
  refuse({"a/b", "a_b"}, {"--camera", "all", "-o", out}, "a_b.exr");
  refuse({"x", "x", "x-1"}, {"--camera", "all", "-o", out}, "x-1.exr");
  refuse({"cameras"}, {"-o", path("{camera}.exr"), "--stats", path("{camera}.gltf")}, "cameras.gltf");
  expect_done(render(scene_of({"rooms/hall"}), {"--camera", "rooms/hall", "-o", out}));
  EXPECT_TRUE(std::filesystem::exists(path("rooms_hall.exr")));
}

TEST_F(ViewFlags, FlagsReplaceTheEntriesOfAViewFileThatTheyExclude) {
  const std::string scene = scene_of({"near", "far"});
  const auto view = [&](const json& content) { return folder.write("view.json", content.dump()); };
  const auto rendered = [&](const std::string& name, const Words& flags) {
    expect_done(render(scene, words_of("-o {}", {path(name)}, flags)));
    return beauty_of(path(name));
  };
  json above = {{"eye", {0, 0, 9}}, {"target", {0, 0, 0}}};
  const std::vector<float> far = rendered("far.exr", {"--camera", "far"});
  EXPECT_EQ(rendered("a.exr", {"--view-file", view(above), "--camera", "far"}), far);
  above["fov"] = 20;
  rendered("b.exr", {"--view-file", view(above), "--lens", "50"});
  const std::string camera = view({{"camera", "far"}});
  EXPECT_NE(rendered("c.exr", {"--view-file", camera, "--eye", "0,0,9", "--target", "0,0,0"}), far);
}

TEST_F(ViewFlags, PartsOfALensWithoutAnApertureAreRefused) {
  const std::string scene = scene_of({"near"});
  for (const char* flag : {"--focus", "--blades"})
    expect_failure(render(scene, {flag, "5", "-o", path("a.exr")}), 1, {flag, "aperture"});
  expect_failure(render(scene, {"--aperture", "f/0", "-o", path("a.exr")}), 1, {"--aperture", "'f/0'"});
}

}  // namespace
}  // namespace gatelight::tests
