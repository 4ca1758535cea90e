// Pictures that go to standard output, and names that are refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "renderer/image/image_read.h"
#include "tests/apps/render_command.h"
#include "tests/support/denoiser.h"

namespace gatelight::tests {
namespace {

using ::testing::HasSubstr;

class StdoutPicture : public SquareRenders {
 protected:
  bool folder_has(const std::string& name) const { return std::filesystem::exists(path(name)); }
};

TEST_F(StdoutPicture, HasTheBytesOfTheFile) {
  const std::pair<const char*, const char*> cases[] = {
      {"-", "a.png"}, {"png:-", "a.png"}, {"exr:-", "a.exr"}, {"JPG:-", "a.jpg"}};
  for (const auto& [name, file] : cases) {
    const Output output = expect_done(render({"-o", name, "-o", path(file), "--reproducible"}));
    EXPECT_EQ(output.out, read_file(path(file))) << name;
    EXPECT_THAT(output.err, HasSubstr("written")) << name;
  }
}

TEST_F(StdoutPicture, IsDenoised) {
  GATELIGHT_NEEDS_DENOISER();
  expect_done(render({"-o", path("a.exr"), "--aov", "denoising", "--quiet"}));
  const Output output =
      expect_done(run_gatelight({"denoise", path("a.exr"), "-o", "-", "-o", path("b.png")}));
  EXPECT_EQ(output.out, read_file(path("b.png")));
}

TEST_F(StdoutPicture, TakesTheFlagsOfItsFormat) {
  const Output output = expect_done(render({"-o", "exr:-", "--aov", "albedo", "--exposure", "1"}));
  EXPECT_THAT(output.err, HasSubstr("--exposure changes nothing"));
  const std::string file = folder.write("a.exr", output.out);
  EXPECT_NE(renderer::read_image(file).find("albedo"), nullptr);
}

TEST_F(StdoutPicture, APipeWithoutAReaderIsOneLine) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  close(ends[0]);
  const Output output =
      run_gatelight({"render", scene, "-o", "-", "--size", "24x16", "--spp", "1", "--quiet"},
                    [&] { dup2(ends[1], STDOUT_FILENO); });
  close(ends[1]);
  expect_failure(output, 3, {"stdout", "Broken pipe"});
}

TEST_F(StdoutPicture, AClosedOrFullStdoutIsOneLine) {
  const Words words = words_of("render {} -o - --size 24x16 --spp 1 --quiet", {scene});
  expect_failure(run_gatelight(words, [] { close(STDOUT_FILENO); }), 3, {"'-'", "closed"});
  const Output full = run_gatelight(words, [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  expect_failure(full, 3, {"stdout"});
}

TEST_F(StdoutPicture, ATerminalIsRefusedBeforeTheWork) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0)
    GTEST_SKIP() << "no pseudo-terminals";
  const std::string name = ptsname(terminal);
  const Output output = run_gatelight({"render", scene, "-o", "png:-"},
                                      [&] { dup2(open(name.c_str(), O_RDWR | O_NOCTTY), STDOUT_FILENO); });
  close(terminal);
  expect_failure(output, 3, {"'png:-'", "terminal"});
}

TEST_F(StdoutPicture, IsTheOnlyResultThere) {
  const auto refused = [&](const Words& flags, const NameList& names) {
    expect_failure(run_gatelight_inside(words_of("render {}", {scene}, flags)), 1, names);
  };
  refused({"-o", "-", "--stats", "-"}, {"--stats", "'-'"});
  refused({"-o", "-", "-o", "exr:-"}, {"--output", "'-'", "'exr:-'"});
  refused({"-o", "gif:-"}, {"'gif:-'", "exr"});
  refused({"-o", "-", "--camera", "all"}, {"--output", "{camera}"});
  expect_failure(run_gatelight_inside({"denoise", path("a.exr"), "-o", "-", "-o", "png:-"}), 1,
                 {"--output", "'png:-'"});
}

TEST_F(StdoutPicture, ASnapshotLeavesItOut) {
  Process process({"render", scene, "-o", "-", "-o", path("a.png"), "--environment", "1,1,1", "--size",
                   "24x16", "--time-limit", "2", "--verbose"});
  ASSERT_TRUE(process.wait_for_error_text("options:"));
  while (process.runs() && !folder_has("a.png")) {
    process.send(SIGUSR1);
    usleep(50000);
  }
  const Output output = expect_done(process.finish());
  EXPECT_THAT(output.err, HasSubstr("snapshot written"));
  EXPECT_EQ(output.out, read_file(path("a.png"))) << "one picture";
}

class NameOfAFrame : public SquareRenders {};

TEST_F(NameOfAFrame, IsRefusedForASinglePicture) {
  for (const char* name : {"a-%04d.png", "%d.png", "a.####.png", "a##.exr", "{frame}.png"}) {
    expect_failure(run_gatelight_inside({"render", scene, "-o", path(name)}), 1, {"--output", name, "frame"});
    expect_failure(run_gatelight_inside({"denoise", path("a.exr"), "-o", path(name)}), 1,
                   {"--output", "frame"});
  }
  expect_failure(run_gatelight_inside({"merge", "-o", path("a%d.exr"), path("b.exr")}), 1,
                 {"--output", "frame"});
  expect_failure(
      run_gatelight_inside({"compare", path("a.exr"), path("b.exr"), "--error-map", path("%3d.png")}), 1,
      {"--error-map", "frame"});
}

TEST_F(NameOfAFrame, OtherNamesStay) {
  std::filesystem::create_directory(path("##"));
  for (const char* name : {"50%.png", "room #3.png", "##/a.png", "a%b.png", "{camera}.png"})
    EXPECT_EQ(render({"-o", path(name), "--quiet"}).exit_code, 0) << name;
}

}  // namespace
}  // namespace gatelight::tests
