#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/support/denoiser.h"
#include "tests/support/folder_test.h"
#include "tests/support/noisy_image.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

class DenoiseCommand : public FolderTest {
 protected:
  std::string render(const std::string& name, const Words& more = {}, const std::string& seed = "1") const {
    expect_done(run_gatelight_inside(
        words_of("render {} -o {} --size 40x32 --spp 8 --environment 1,0.9,0.8 --seed {} --quiet",
                 {folder.write("scene.gltf", tiny_scene()), path(name), seed}, more)));
    return path(name);
  }
  Output denoise(const std::string& input, const std::string& output, const Words& more = {}) const {
    return run_gatelight_inside(words_of("denoise {} -o {}", {path(input), path(output)}, more));
  }
};

TEST_F(DenoiseCommand, GivesTheFinishedPicture) {
  GATELIGHT_NEEDS_DENOISER();
  for (const char* const flags :
       {"", "--supersampling 2 --filter tent", "--prefilter fast --background transparent",
        "--background 0.5,0,1 --exposure 1 --tonemap agx"}) {
    const std::string finished = render(
        "finished.exr",
        words_of("--denoiser oidn --aov denoising,depth -o {}", {path("finished.png")}, words_of(flags)));
    const Output output =
        expect_done(run_gatelight({"denoise", finished, "-o", path("again.exr"), "-o", path("again.png")}));
    EXPECT_NE(output.err.find("Open Image Denoise 2."), std::string::npos) << output.err;
    const renderer::Picture again = renderer::read_image(path("again.exr"));
    EXPECT_EQ(again.layers[0].values, beauty_of(finished));
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
      beauty_of(render("finished.exr", {"--denoiser", "oidn", "--prefilter", "none"}));
  for (const char* const denoiser : {"oidn", "none"}) {
    const std::string input =
        render("a.exr", {"--denoiser", denoiser, "--prefilter", "none", "--aov", "denoising"});
    expect_done(denoise(input, "b.exr", {"--quiet"}));
    EXPECT_EQ(beauty_of(path("b.exr")), finished) << denoiser;
    expect_done(denoise(input, "b.exr", {"--quiet", "--prefilter", "fast"}));
    EXPECT_NE(beauty_of(path("b.exr")), finished) << denoiser;
  }
}

TEST_F(DenoiseCommand, FinishesMergedPartsOfAPicture) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string a = render("a.exr", {"--aov", "denoising"}, "1"),
                    b = render("b.exr", {"--aov", "denoising"}, "2");
  expect_done(run_gatelight_inside({"merge", a, b, "-o", path("merged.exr")}));
  const Output output = expect_done(denoise("merged.exr", "finished.exr", {"--quiet"}));
  EXPECT_EQ(output.out + output.err, "");
  EXPECT_NE(beauty_of(path("finished.exr")), beauty_of(path("merged.exr")));
  EXPECT_EQ(renderer::read_image(path("finished.exr")).metadata.at("spp"), "16");
}

/// A picture of another program: noisy_image() in layers of these names and channels.
struct NamedLayers {
  std::string color, albedo, normal;
  std::vector<std::string> channels = {"R", "G", "B"};
};

constexpr int kWidth = 48, kHeight = 40;

renderer::Picture picture_of(const renderer::NoisyImage& image, const NamedLayers& names) {
  renderer::Picture picture{.width = image.width, .height = image.height};
  const auto add = [&](const std::string& name, const std::vector<float>& values,
                       std::vector<std::string> channels) {
    if (name != "none") picture.layers.push_back({name, std::move(channels), values, true});
  };
  add(names.color, image.color, names.channels);
  add(names.albedo, image.albedo, names.channels);
  add(names.normal, image.normal, {"X", "Y", "Z"});
  return picture;
}

/// How far a layer is from the picture without noise.
double error_of(const std::string& file, const std::string& layer) {
  const renderer::Picture picture = renderer::read_image(file);
  return testing::deviation(picture.find(layer)->values, testing::clean_image(kWidth, kHeight).color);
}

TEST_F(DenoiseCommand, ReplacesTheLayerThatIsNamedAndNoOther) {
  GATELIGHT_NEEDS_DENOISER();
  const renderer::NoisyImage image = testing::noisy_image(kWidth, kHeight);
  write_image(picture_of(image, {"image", "albedo", "sh_normal"}), path("a.exr"), {.exr_float = true});
  const Output output =
      expect_done(denoise("a.exr", "b.exr", {"--color-layer", "image", "--normal-layer", "sh_normal"}));
  EXPECT_NE(output.err.find("'image', with 'albedo' and 'sh_normal'"), std::string::npos) << output.err;
  const renderer::Picture picture = renderer::read_image(path("b.exr"));
  EXPECT_EQ(picture.find("albedo")->values, image.albedo);
  EXPECT_EQ(picture.find("sh_normal")->values, image.normal);
  EXPECT_LT(error_of(path("b.exr"), "image"), 0.2 * error_of(path("a.exr"), "image"));
  expect_done(denoise("a.exr", "c.exr", {"--quiet"}));
  EXPECT_EQ(read_file(path("c.exr")), read_file(path("b.exr"))) << "the usual names are the same layers";
}

TEST_F(DenoiseCommand, OneGuideIsBetterThanNone) {
  GATELIGHT_NEEDS_DENOISER();
  const renderer::NoisyImage image = testing::noisy_image(kWidth, kHeight);
  const auto error = [&](const NamedLayers& names, Words flags = {}) {
    write_image(picture_of(image, names), path("a.exr"), {.exr_float = true});
    flags.insert(flags.begin(), {"denoise", path("a.exr"), "-o", path("b.exr"), "--quiet"});
    expect_done(run_gatelight_inside(flags));
    return error_of(path("b.exr"), names.color);
  };
  const double none = error({"V.Combined", "none", "none"});
  EXPECT_LT(error({"V.Combined", "V.Denoising Albedo", "none"}), none);
  EXPECT_LT(error({"V.Combined", "none", "V.Normal"}), none);
  EXPECT_EQ(
      error({"V.Combined", "V.Albedo", "V.Normal"}, {"--albedo-layer", "none", "--normal-layer", "none"}),
      none);
}

TEST_F(DenoiseCommand, DenoisesGreyPicturesAndSeveralViewLayers) {
  GATELIGHT_NEEDS_DENOISER();
  const renderer::NoisyImage image = testing::noisy_image(kWidth, kHeight),
                             other = testing::noisy_image(kWidth, kHeight, 2);
  renderer::Picture grey{.width = kWidth, .height = kHeight};
  grey.layers = {{"", {"A", "Y"}, {}, true}};
  for (std::size_t i = 0; i < image.color.size(); i += 3)
    grey.layers[0].values.insert(grey.layers[0].values.end(), {0.5f, image.color[i]});
  write_image(grey, path("grey.exr"), {.exr_float = true});
  expect_done(denoise("grey.exr", "b.exr", {"--quiet"}));
  const renderer::Layer read = renderer::read_image(path("b.exr")).layers[0];
  ASSERT_EQ(read.channels, (std::vector<std::string>{"A", "Y"}));
  const std::vector<float> clean = testing::clean_image(kWidth, kHeight).color;
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < image.color.size() / 3; ++i) {
    EXPECT_EQ(read.values[2 * i], 0.5f);
    before += std::abs(image.color[3 * i] - clean[3 * i]);
    after += std::abs(read.values[2 * i + 1] - clean[3 * i]);
  }
  EXPECT_LT(after, 0.3 * before);

  renderer::Picture two = picture_of(image, {"V.Combined", "V.Denoising Albedo", "none"});
  for (renderer::Layer& layer : picture_of(other, {"O.Combined", "none", "O.Normal"}).layers)
    two.layers.push_back(layer);
  two.layers.push_back({"Composite.Combined", {"R", "G", "B"}, image.color, true});
  write_image(two, path("two.exr"), {.exr_float = true});
  const Output output = denoise("two.exr", "c.exr");
  EXPECT_NE(output.err.find("left      'Composite.Combined'"), std::string::npos) << output.err;
  for (const char* const layer : {"V.Combined", "O.Combined"})
    EXPECT_LT(error_of(path("c.exr"), layer), 0.2 * error_of(path("two.exr"), layer)) << layer;
  EXPECT_EQ(renderer::read_image(path("c.exr")).find("Composite.Combined")->values, image.color);
}

TEST_F(DenoiseCommand, FramesAreThoseThatExistOrThatAreNamed) {
  GATELIGHT_NEEDS_DENOISER();
  for (const char* const name : {"in-0001.exr", "in-0003.exr", "in-12.exr", "on-0005.exr", "in-0007.png"})
    write_image(picture_of(testing::noisy_image(kWidth, kHeight), {"", "none", "none"}), path(name));
  const Output all = expect_done(denoise("in-%04d.exr", "out-%04d.exr", {"-o", path("out-%04d.png")}));
  EXPECT_NE(all.err.find("2 frames"), std::string::npos) << all.err;
  for (const char* const name : {"out-0001.exr", "out-0003.exr", "out-0001.png", "out-0003.png"})
    EXPECT_TRUE(std::filesystem::exists(path(name))) << name;
  expect_done(denoise("in-%04d.exr", "n-%04d.exr", {"--frames", "3"}));
  EXPECT_FALSE(std::filesystem::exists(path("n-0001.exr")));
  EXPECT_EQ(read_file(path("n-0003.exr")), read_file(path("out-0003.exr")));
  expect_failure(denoise("in-%04d.exr", "o-%04d.exr", {"--frames", "1:3"}), 2, {"in-0002.exr"});
  expect_failure(denoise("no-%04d.exr", "o-%04d.exr"), 2, {"no-%04d.exr"});
  expect_failure(denoise("in-%04d.exr", "o.exr"), 1, {"o.exr", "%04d"});
  expect_failure(denoise("in-%04d.exr", "in-%04d.exr"), 1, {"INPUT"});
}

TEST_F(DenoiseCommand, PutsAnotherBackgroundBehindThePicture) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string input = render("a.exr", {"--aov", "denoising", "--background", "transparent"});
  const std::string red = render("red.exr", {"--denoiser", "oidn", "--background", "1,0,0"});
  expect_done(denoise(input, "b.exr", {"--quiet", "--background", "1,0,0"}));
  EXPECT_EQ(beauty_of(path("b.exr")), beauty_of(red));
  // Its samples have no alpha.
  const std::string raw = render("raw.exr", {"--denoiser", "oidn", "--aov", "raw", "--background", "1,0,0"});
  expect_failure(denoise(raw, "o.exr"), 2, {"raw.exr", "alpha", "--aov denoising"});
}

TEST_F(DenoiseCommand, WrongFilesAreRefused) {
  GATELIGHT_NEEDS_DENOISER();
  const std::string finished = render("finished.exr", {"--denoiser", "oidn"});
  expect_failure(denoise(finished, "o.exr"), 2, {"finished.exr", "denoised already", "--aov denoising"});
  expect_failure(denoise("missing.exr", "o.exr"), 2, {"missing.exr"});
  expect_failure(denoise("picture.png", "o.exr"), 1, {"picture.png", ".exr"});
  expect_failure(denoise(finished, "no/o.exr"), 3, {"no"});
  expect_failure(denoise(finished, finished), 1, {"--output", "INPUT"});
  EXPECT_FALSE(std::filesystem::exists(path("o.exr")));
}

TEST_F(DenoiseCommand, WithoutTheLibraryPresetsWarnAndTheDenoiserRefuses) {
  const std::string scene = folder.write("scene.gltf", tiny_scene());
  const auto run = [&](const Words& words) {
    return run_gatelight_inside(words_of("render --size 24x16 --environment 1,1,1 --oidn /none", {}, words));
  };
  const Output warned = expect_done(run({scene, "-o", path("p.png"), "--preset", "preview"}));
  EXPECT_NE(warned.err.find("Open Image Denoise"), std::string::npos) << warned.err;
  EXPECT_TRUE(std::filesystem::exists(path("p.png")));
  expect_failure(run({scene, "-o", path("q.png"), "--denoiser", "oidn"}), 5,
                 {"/none", "--oidn", "scripts/setup"});
  // Before the scene is read.
  expect_failure(run({path("broken.gltf"), "-o", path("q.png"), "--denoiser", "oidn"}), 2, {"broken"});
  EXPECT_FALSE(std::filesystem::exists(path("q.png")));
  expect_failure(denoise("p.png", "o.exr"), 1, {"p.png"});
}

}  // namespace
}  // namespace gatelight::tests
