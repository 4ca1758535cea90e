#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "tests/support/denoiser.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

class DenoiseCommand : public FolderTest {
 protected:
  std::string render(const std::string& name, const std::vector<std::string>& more = {},
                     const std::string& seed = "1") const {
    std::vector<std::string> words = {"render",
                                      folder.write("scene.gltf", tiny_scene()),
                                      "-o",
                                      path(name),
                                      "--size",
                                      "40x32",
                                      "--spp",
                                      "8",
                                      "--environment",
                                      "1,0.9,0.8",
                                      "--seed",
                                      seed,
                                      "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const Output output = run_gatelight_inside(words);
    EXPECT_EQ(output.exit_code, 0) << output.err;
    return path(name);
  }
  static std::vector<float> beauty(const std::string& file) {
    return renderer::read_image(file).layers[0].values;
  }
};

TEST_F(DenoiseCommand, GivesTheFinishedPicture) {
  GATELIGHT_NEEDS_DENOISER();
  const std::vector<std::vector<std::string>> flags = {
      {"--denoiser", "oidn"},
      {"--denoiser", "oidn", "--supersampling", "2", "--filter", "tent"},
      {"--denoiser", "oidn", "--prefilter", "fast", "--background", "transparent"},
      {"--denoiser", "oidn", "--background", "0.5,0,1", "--exposure", "1", "--tonemap", "agx"}};
  for (const std::vector<std::string>& some : flags) {
    std::vector<std::string> more = some;
    more.insert(more.end(), {"--aov", "denoising,depth", "-o", path("finished.png")});
    const std::string finished = render("finished.exr", more);
    const Output output =
        run_gatelight({"denoise", finished, "-o", path("again.exr"), "-o", path("again.png")});
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_NE(output.err.find("Open Image Denoise 2."), std::string::npos) << output.err;
    const renderer::Picture again = renderer::read_image(path("again.exr"));
    EXPECT_EQ(again.layers[0].values, beauty(finished));
    EXPECT_EQ(read_file(path("again.png")), read_file(path("finished.png")));
    ASSERT_EQ(again.layers.size(), 2u) << "other layers stay";
    EXPECT_EQ(again.layers[1].name, "depth");
    EXPECT_TRUE(again.metadata.at("denoiser").starts_with("Open Image Denoise 2."));
  }
}

/// A picture that is not denoised has the recipe too.
TEST_F(DenoiseCommand, ReadsTheGuidesAsTheRecipeSays) {
  GATELIGHT_NEEDS_DENOISER();
  const std::vector<float> finished =
      beauty(render("finished.exr", {"--denoiser", "oidn", "--prefilter", "none"}));
  for (const char* const denoiser : {"oidn", "none"}) {
    const std::string input =
        render("a.exr", {"--denoiser", denoiser, "--prefilter", "none", "--aov", "denoising"});
    ASSERT_EQ(run_gatelight_inside({"denoise", input, "-o", path("b.exr"), "--quiet"}).exit_code, 0);
    EXPECT_EQ(beauty(path("b.exr")), finished) << denoiser;
    ASSERT_EQ(
        run_gatelight_inside({"denoise", input, "-o", path("b.exr"), "--quiet", "--prefilter", "accurate"})
            .exit_code,
        0);
    EXPECT_NE(beauty(path("b.exr")), finished) << denoiser;
  }
}

TEST_F(DenoiseCommand, FinishesMergedPartsOfAPicture) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string a = render("a.exr", {"--aov", "denoising"}, "1"),
                    b = render("b.exr", {"--aov", "denoising"}, "2");
  ASSERT_EQ(run_gatelight_inside({"merge", a, b, "-o", path("merged.exr")}).exit_code, 0);
  const Output output =
      run_gatelight_inside({"denoise", path("merged.exr"), "-o", path("finished.exr"), "--quiet"});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(output.out + output.err, "");
  EXPECT_NE(beauty(path("finished.exr")), beauty(path("merged.exr")));
  EXPECT_EQ(renderer::read_image(path("finished.exr")).metadata.at("spp"), "16");
}

TEST_F(DenoiseCommand, TakesLayersOfOtherNames) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string input = render("a.exr", {"--aov", "albedo,normal"});
  ASSERT_EQ(run_gatelight_inside({"denoise", input, "-o", path("usual.exr"), "--quiet"}).exit_code, 0);
  ASSERT_EQ(run_gatelight_inside({"denoise", input, "-o", path("named.exr"), "--quiet", "--albedo-layer",
                                  "albedo", "--normal-layer", "normal"})
                .exit_code,
            0);
  EXPECT_NE(beauty(path("usual.exr")), beauty(input));
  EXPECT_EQ(beauty(path("usual.exr")), beauty(path("named.exr")));
  expect_failure(run_gatelight_inside({"denoise", input, "-o", path("o.exr"), "--normal-layer", "N"}), 2,
                 {"a.exr", "'N'"});
}

TEST_F(DenoiseCommand, PutsAnotherBackgroundBehindThePicture) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string input = render("a.exr", {"--aov", "denoising", "--background", "transparent"});
  const std::string red = render("red.exr", {"--denoiser", "oidn", "--background", "1,0,0"});
  ASSERT_EQ(run_gatelight_inside({"denoise", input, "-o", path("b.exr"), "--quiet", "--background", "1,0,0"})
                .exit_code,
            0);
  EXPECT_EQ(beauty(path("b.exr")), beauty(red));
  // Its samples have no alpha.
  const std::string raw = render("raw.exr", {"--denoiser", "oidn", "--aov", "raw", "--background", "1,0,0"});
  expect_failure(run_gatelight_inside({"denoise", raw, "-o", path("o.exr")}), 2,
                 {"raw.exr", "alpha", "--aov denoising"});
}

TEST_F(DenoiseCommand, ThreadsDoNotChangeTheFile) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string input = render("a.exr", {"--aov", "denoising"});
  for (const char* threads : {"1", "2"}) {
    const std::string output = path(std::string(threads) + ".exr");
    ASSERT_EQ(
        run_gatelight_inside({"denoise", input, "-o", output, "--threads", threads, "--quiet"}).exit_code, 0);
  }
  EXPECT_EQ(read_file(path("1.exr")), read_file(path("2.exr")));
}

TEST_F(DenoiseCommand, WrongFilesAreRefused) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string finished = render("finished.exr", {"--denoiser", "oidn"});
  expect_failure(run_gatelight_inside({"denoise", finished, "-o", path("o.exr")}), 2,
                 {"finished.exr", "denoised already", "--aov denoising"});
  expect_failure(run_gatelight_inside({"denoise", path("missing.exr"), "-o", path("o.exr")}), 2,
                 {"missing.exr"});
  expect_failure(run_gatelight_inside({"denoise", path("picture.png"), "-o", path("o.exr")}), 1,
                 {"picture.png", ".exr"});
  expect_failure(run_gatelight_inside({"denoise", finished, "-o", path("no/o.exr")}), 3, {"no"});
  expect_failure(run_gatelight_inside({"denoise", finished, "-o", finished}), 1, {"--output", "INPUT"});
  EXPECT_FALSE(std::filesystem::exists(path("o.exr")));
}

TEST_F(DenoiseCommand, WithoutTheLibraryPresetsWarnAndTheDenoiserRefuses) {
  const std::string scene = folder.write("scene.gltf", tiny_scene());
  const std::vector<std::string> small = {"--size", "24x16", "--environment", "1,1,1", "--oidn", "/none"};
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.end(), small.begin(), small.end());
    return run_gatelight_inside(words);
  };
  const Output warned = run({"render", scene, "-o", path("p.png"), "--preset", "preview"});
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_NE(warned.err.find("warning: the picture keeps its noise: Open Image Denoise was not found"),
            std::string::npos)
      << warned.err;
  EXPECT_EQ(warned.err.find("scripts/setup"), std::string::npos) << "it would not help";
  EXPECT_TRUE(std::filesystem::exists(path("p.png")));
  expect_failure(run({"render", scene, "-o", path("q.png"), "--denoiser", "oidn"}), 5,
                 {"/none", "--oidn", "scripts/setup"});
  // Before the scene is read.
  expect_failure(run({"render", path("broken.gltf"), "-o", path("q.png"), "--denoiser", "oidn"}), 2,
                 {"broken"});
  EXPECT_FALSE(std::filesystem::exists(path("q.png")));
  expect_failure(run_gatelight_inside({"denoise", path("p.png"), "-o", path("o.exr")}), 1, {"p.png"});
}

}  // namespace
}  // namespace gatelight::tests
