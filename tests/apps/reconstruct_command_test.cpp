#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

class ReconstructCommand : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder / name).string(); }

  std::string render(const std::string& name, const std::string& seed, const std::string& layers,
                     const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"render",
                                      folder.write("scene.gltf", tiny_scene()),
                                      "-o",
                                      path(name),
                                      "--size",
                                      "24x16",
                                      "--spp",
                                      "4",
                                      "--environment",
                                      "1,0.9,0.8",
                                      "--seed",
                                      seed,
                                      "--aov",
                                      layers,
                                      "--exr",
                                      "float",
                                      "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const Output output = run_gatelight_inside(words);
    EXPECT_EQ(output.exit_code, 0) << output.err;
    return path(name);
  }

  TemporaryFolder folder;
};

TEST_F(ReconstructCommand, RefusesPicturesWithABackgroundOfTheirOwn) {
  for (const char* background : {"1,1,1", "transparent"}) {
    const std::string samples = render("a.exr", "1", "reconstruction", {"--background", background});
    const Output output = run_gatelight({"reconstruct", samples, "-o", path("finished.exr")});
    EXPECT_EQ(output.exit_code, 2);
    EXPECT_NE(output.err.find("background"), std::string::npos) << output.err;
  }
}

TEST_F(ReconstructCommand, FinishesWhatRenderAndMergeWrite) {
  const std::string a = render("a.exr", "1", "reconstruction"), b = render("b.exr", "2", "reconstruction");
  ASSERT_EQ(run_gatelight_inside({"merge", a, b, "-o", path("merged.exr")}).exit_code, 0);
  for (const std::string& input : {a, path("merged.exr")}) {
    const Output output = run_gatelight({"reconstruct", input, "-o", path("finished.exr")});
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_EQ(output.out + output.err, "");
    const renderer::Picture samples = renderer::read_image(input);
    const renderer::Picture finished = renderer::read_image(path("finished.exr"));
    ASSERT_EQ(finished.layers.size(), 3u);
    EXPECT_NE(finished.layers[0].values, samples.layers[0].values);
    ASSERT_TRUE(finished.find("raw") && finished.find("error"));
    for (std::size_t i = 0; i < samples.layers[0].values.size(); ++i)  // half precision
      ASSERT_NEAR(finished.find("raw")->values[i], samples.layers[0].values[i], 1e-3f);
    EXPECT_EQ(finished.metadata.at("spp"), samples.metadata.at("spp"));
    EXPECT_EQ(finished.metadata.at("reconstructed"), "yes");
  }
  EXPECT_EQ(run_gatelight_inside({"reconstruct", a, "-o", path("finished.png")}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("finished.png")));
}

TEST_F(ReconstructCommand, RenderGivesWhatReconstructGives) {
  const std::string samples = render("samples.exr", "1", "reconstruction");
  ASSERT_EQ(run_gatelight_inside({"reconstruct", samples, "-o", path("command.exr")}).exit_code, 0);
  // With a clamp, even one that nothing reaches, a render takes no more points at edges, as the command
  // cannot.
  const std::string flag =
      render("flag.exr", "1", "raw,error", {"--reconstruct", "on", "--adaptive", "off", "--clamp", "1e9"});
  const renderer::Picture one = renderer::read_image(flag);
  const renderer::Picture other = renderer::read_image(path("command.exr"));
  ASSERT_EQ(one.layers.size(), 3u);
  for (const renderer::Layer& layer : one.layers) {
    ASSERT_TRUE(other.find(layer.name)) << layer.name;
    for (std::size_t i = 0; i < layer.values.size(); ++i)  // half precision
      ASSERT_NEAR(other.find(layer.name)->values[i], layer.values[i], 1e-3f) << layer.name;
  }
}

TEST_F(ReconstructCommand, ThreadsDoNotChangeTheFile) {
  const std::string input = render("a.exr", "1", "reconstruction");
  for (const char* threads : {"1", "2"}) {
    const std::string output = path(std::string(threads) + ".exr");
    ASSERT_EQ(run_gatelight_inside({"reconstruct", input, "-o", output, "--threads", threads}).exit_code, 0);
  }
  EXPECT_EQ(renderer::read_image(path("1.exr")).layers[0].values,
            renderer::read_image(path("2.exr")).layers[0].values);
}

TEST_F(ReconstructCommand, WrongFilesAreRefused) {
  const std::string plain = render("plain.exr", "1", "albedo");
  expect_failure(run_gatelight_inside({"reconstruct", plain, "-o", path("o.exr")}), 2,
                 {"plain.exr", "half-a", "--aov reconstruction"});
  expect_failure(run_gatelight_inside({"reconstruct", path("missing.exr"), "-o", path("o.exr")}), 2,
                 {"missing.exr"});
  expect_failure(run_gatelight_inside({"reconstruct", path("picture.png"), "-o", path("o.exr")}), 1,
                 {"picture.png", ".exr"});
  expect_failure(run_gatelight_inside({"reconstruct", plain, "-o", path("no/o.exr")}), 3, {"no"});
  EXPECT_FALSE(std::filesystem::exists(path("o.exr")));
}

}  // namespace
}  // namespace gatelight::tests
