#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

class MergeCommand : public FolderTest {
 protected:
  static Output merge(const Words& words) { return run_gatelight_inside(words_of("merge", {}, words)); }

  std::string picture(const std::string& name, int width, float value,
                      std::map<std::string, std::string> metadata = {}) const {
    return write_even(path(name), width, 1, value, std::move(metadata));
  }
};

TEST_F(MergeCommand, EqualSeedsGiveAWarning) {
  const std::string a = picture("a.exr", 1, 1.0f, {{"spp", "1"}, {"seed", "7"}});
  const std::string b = picture("b.exr", 1, 2.0f, {{"spp", "1"}, {"seed", "7"}});
  const Output output = expect_done(merge({"-o", path("m.exr"), a, b}));
  expect_messages(output.error_lines(), {{"a.exr", "b.exr", "7"}});
  EXPECT_EQ(beauty_of(path("m.exr")), std::vector<float>(3, 1.5f));
}

TEST_F(MergeCommand, WrongFilesAreRefused) {
  const std::string a = picture("a.exr", 1, 1.0f);
  const auto code = [&](const Words& words) {
    const Output output = merge(words);
    EXPECT_EQ(output.out, "");
    return output.exit_code;
  };
  EXPECT_EQ(code({"-o", path("m.png"), a, a}), 1);
  EXPECT_EQ(code({"-o", path("m.exr"), a, path("b.png")}), 1);
  EXPECT_EQ(code({"-o", path("m.exr")}), 1);
  EXPECT_EQ(code({a, a}), 1);
  EXPECT_EQ(code({"-o", path("no/m.exr"), a, a}), 3);
  EXPECT_EQ(code({"-o", path("m.exr"), a, path("missing.exr")}), 2);
  expect_failure(merge({"-o", path("m.exr"), a, picture("wide.exr", 2, 1.0f)}), 2,
                 {"a.exr", "wide.exr", "2x1"});
  EXPECT_FALSE(std::filesystem::exists(path("m.exr")));
}

TEST_F(MergeCommand, PicturesThatAreNotFiniteAreRefused) {
  const std::string good = picture("a.exr", 2, 1.0f, {{"scene", "a/room.glb"}});
  for (const float value : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    const std::string bad = picture("b.exr", 2, value);
    const Output output = merge({"-o", path("m.exr"), good, bad});
    expect_failure(output, 2, {bad, "6"});
    EXPECT_FALSE(std::filesystem::exists(path("m.exr")));
  }
  const std::string same = picture("c.exr", 2, 1.0f, {{"scene", "b/room.glb"}});
  EXPECT_EQ(merge({"-o", path("m.exr"), good, same}).err, "");
  const std::string other = picture("d.exr", 2, 1.0f, {{"scene", "a/hall.glb"}});
  const Output warned = expect_done(merge({"-o", path("m.exr"), good, other}));
  expect_messages(warned.error_lines(), {{"hall.glb", "room.glb"}});
}

}  // namespace
}  // namespace gatelight::tests
