// Cameras and views through the real program: --camera all, {camera} in names, --view-file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "renderer/image/image_read.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

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
  Output render(const std::string& scene, const std::vector<std::string>& flags) const {
    std::vector<std::string> arguments = {"render", scene,   "--size", "24x16",         "--spp",
                                          "1",      "--exr", "float",  "--reproducible"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    return run_gatelight(arguments);
  }
  std::string file(const std::string& name) const { return (folder / name).string(); }
  std::vector<float> values(const std::string& name) const {
    return renderer::read_image(file(name)).layers[0].values;
  }
};

TEST_F(ViewFlags, CameraAllRendersEveryCameraWhateverItsName) {
  const std::string scene = scene_of({"2", "0", "twin", "twin"});
  const Output all =
      render(scene, {"--camera", "all", "-o", file("{camera}.exr"), "--stats", file("{camera}.json")});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(render(scene, {"--camera", "2", "-o", file("first.exr")}).exit_code, 0);
  EXPECT_EQ(values("2.exr"), values("first.exr"));
  EXPECT_EQ(render(scene, {"--camera", "0", "-o", file("second.exr")}).exit_code, 0);
  EXPECT_EQ(values("0.exr"), values("second.exr"));
  EXPECT_NE(values("2.exr"), values("0.exr"));
  EXPECT_NE(values("twin-2.exr"), values("twin-3.exr"));
  EXPECT_TRUE(std::filesystem::exists(file("twin-3.json")));
}

TEST_F(ViewFlags, NamesOfCamerasNeverOverwriteAFile) {
  const auto refuse = [&](const std::vector<std::string>& names, const std::vector<std::string>& flags,
                          const std::string& of) {
    const Output output = render(scene_of(names), flags);
    EXPECT_EQ(output.exit_code, 1) << output.err;
    EXPECT_THAT(output.err, HasSubstr(of));
  };
  const std::string out = file("{camera}.exr");
  refuse({"a/b", "a_b"}, {"--camera", "all", "-o", out}, "a_b.exr");
  refuse({"x", "x", "x-1"}, {"--camera", "all", "-o", out}, "x-1.exr");
  refuse({"cameras"}, {"-o", file("{camera}.exr"), "--stats", file("{camera}.gltf")}, "cameras.gltf");
  EXPECT_EQ(render(scene_of({"rooms/hall"}), {"--camera", "rooms/hall", "-o", out}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(file("rooms_hall.exr")));
}

TEST_F(ViewFlags, FlagsReplaceTheEntriesOfAViewFileThatTheyExclude) {
  const std::string scene = scene_of({"near", "far"});
  const auto view = [&](const json& content) { return folder.write("view.json", content.dump()); };
  const auto expect_done = [&](const std::vector<std::string>& flags) {
    const Output output = render(scene, flags);
    EXPECT_EQ(output.exit_code, 0) << output.err;
  };
  expect_done({"--camera", "far", "-o", file("far.exr")});
  expect_done({"--view-file", view({{"eye", {0, 0, 9}}, {"target", {0, 0, 0}}}), "--camera", "far", "-o",
               file("a.exr")});
  EXPECT_EQ(values("a.exr"), values("far.exr"));
  expect_done({"--view-file", view({{"eye", {0, 0, 9}}, {"target", {0, 0, 0}}, {"fov", 20}}), "--lens", "50",
               "-o", file("b.exr")});
  expect_done(
      {"--view-file", view({{"camera", "far"}}), "--eye", "0,0,9", "--target", "0,0,0", "-o", file("c.exr")});
  EXPECT_NE(values("c.exr"), values("far.exr"));
}

TEST_F(ViewFlags, PartsOfALensWithoutAnApertureAreRefused) {
  const std::string scene = scene_of({"near"});
  for (const char* flag : {"--focus", "--blades"}) {
    const Output output = render(scene, {flag, "5", "-o", file("a.exr")});
    EXPECT_EQ(output.exit_code, 1);
    EXPECT_THAT(output.err, HasSubstr(std::string(flag) + ": without an aperture"));
  }
  EXPECT_THAT(render(scene, {"--aperture", "f/0", "-o", file("a.exr")}).err, HasSubstr("--aperture: 'f/0'"));
}

}  // namespace
}  // namespace gatelight::tests
