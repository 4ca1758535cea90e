// Words and scenes of other renderers are told what they are here.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using ::testing::HasSubstr;

class OtherTools : public FolderTest {
 protected:
  std::string scene() const { return folder.write("scene.gltf", tiny_scene()); }
};

TEST_F(OtherTools, TellsWhatWordsOfOtherToolsAreHere) {
  const std::string square = scene();
  for (const auto& [arguments, hint] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{square}, "gatelight render " + square + " -o picture.png"},
           {{"help"}, "did you mean '--help'?"},
           {{"-b", "a.blend"}, "here it is 'gatelight render"},
           {{"render", square, "a.png"}, "did you mean '-o a.png'?"},
           {{"render", square, "-o", "a.png", "--samples", "4"}, "here it is '--spp N'"},
           {{"render", square, "-o", "a.png", "-t", "4"}, "here it is '--threads N'"},
           {{"render", square, "--outfile", "a.png"}, "here it is '-o FILE'"},
           {{"render", square, "-o", "a.png", "--resolution", "64x48"},
            "the size of the picture is --size WxH"}}) {
    const Output output = run_gatelight_inside(arguments);
    EXPECT_EQ(output.exit_code, 1);
    EXPECT_THAT(output.last_error_line(), HasSubstr(hint));
  }
}

TEST_F(OtherTools, ScenesOfOtherToolsAreNamed) {
  for (const auto& [name, format] : std::vector<std::pair<std::string, std::string>>{
           {"a.blend", "a scene of Blender"}, {"a.pbrt", "a scene of pbrt"}, {"a.obj", "Wavefront OBJ"}}) {
    const Output output = run_gatelight_inside({"info", folder.write(name, "x")});
    EXPECT_EQ(output.exit_code, 2);
    EXPECT_THAT(output.last_error_line(), HasSubstr(name + ": " + format + ", expected glTF 2.0"));
  }
}

}  // namespace
}  // namespace gatelight::tests
