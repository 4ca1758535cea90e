// The same frame is the same file, whatever range it is rendered in, through the real program.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "tests/support/animated_file.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

const char* const kMovingRoom = GATELIGHT_SOURCE_DIR "/data/moving-room.glb";

class Film : public FolderTest {
 protected:
  static Output render(const std::string& scene, Words flags) {
    flags.insert(flags.begin(), {"render", scene});
    return expect_done(run_gatelight(flags));
  }

  float exposure_of(const std::string& stats) const {
    return nlohmann::json::parse(read_file(path(stats)))["exposure"].get<float>();
  }
  std::vector<float> layer(const std::string& file, const std::string& name) const {
    for (const renderer::Layer& layer : renderer::read_image(path(file)).layers) {
      if (layer.name == name) return layer.values;
    }
    ADD_FAILURE() << file << " has no layer " << name;
    return {};
  }
  void expect_same_files(const std::string& a, const std::string& b) const {
    for (const char* extension : {".png", ".exr"})
      EXPECT_TRUE(read_file(path(a + extension)) == read_file(path(b + extension))) << a << b << extension;
  }
};

TEST_F(Film, HasTheSameFilesInAnyRange) {
  const auto run = [&](const std::string& name, const Words& more) {
    return render(kMovingRoom,
                  words_of("--preset preview --integrator path --temporal off --spp 2 --size 32x18 --aov "
                           "motion,motion-next --exr float --reproducible -o {} -o {}",
                           {path(name + "-%d.exr"), path(name + "-%d.png")}, more));
  };
  const Output whole = run("all", {"--frames", "4:7", "--threads", "1"});
  EXPECT_NE(whole.err.find("exposure "), std::string::npos) << whole.err;
  EXPECT_EQ(whole.err.find("part "), std::string::npos) << "frames do not depend on each other\n"
                                                        << whole.err;
  for (const char* frames : {"6", "5:6", "6:5:-1", "4:6:2", "6,0"}) {
    run("part", {"--frames", frames});
    expect_same_files("part-6", "all-6");
  }
  std::filesystem::remove(path("part-6.png"));
  run("part", {"--frames", "5:6", "--skip-existing"});
  expect_same_files("part-6", "all-6");
}

TEST_F(Film, OfWhichAPartIsRenderedSaysWhatDiffers) {
  const auto part = [&](const Words& more) {
    const std::string text =
        render(kMovingRoom, words_of("--size 16x9 --spp 1 -o {}", {path("f-%d.exr")}, more)).err;
    const std::size_t at = text.find("part ");
    return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
  };
  const auto with = [&](const Words& more) {
    return words_of("--preset standard --integrator nrc --train-steps 16 --denoiser none", {}, more);
  };
  expect_message(part(with({"--frames", "0:1"})),
                 {"frames 0 to 48", "the reused cache", "--integrator path"});
  expect_message(part({"--frames", "3", "--denoiser", "auto"}), {"reused samples", "--temporal off"});
  EXPECT_EQ(part(with({"--frames", "0:4", "--fps", "2"})), "") << "all of it";
  EXPECT_EQ(part({"--frames", "3"}), "");
  EXPECT_EQ(part(with({"--turntable", "2"})), "") << "all of the turn";
  EXPECT_NE(part(with({"--turntable", "3", "--frames", "1:2"})), "");
}

/// A triangle that goes 2 pixels to the right and 1 up with each frame of 32x32 pixels, from frame 0 to 24.
TEST_F(Film, MovesFromTheFrameBeforeAndToTheNext) {
  scene::AnimatedFile file = scene::moving_triangle();
  file.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 100}}}});
  file.node({{"camera", 0}, {"translation", {0, 0, 10}}});
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({-1.5f, -0.75f, 0, 1.5f, 0.75f, 0})});
  const std::string scene = file.write(folder).string();
  const auto moves = [&](const std::string& frames, int frame, const char* name) {
    render(scene, {"--frames", frames, "--aov", "motion,motion-next", "--size", "32x32", "--spp", "1",
                   "--environment", "1,1,1", "-o", path("m-%d.exr")});
    const std::vector<float> values = layer("m-" + std::to_string(frame) + ".exr", name);
    const std::size_t pixel = 32 * 12 + 20;  // on the triangle in frames 12 and 13
    return std::pair(std::round(1000.0f * values[2 * pixel]), std::round(1000.0f * values[2 * pixel + 1]));
  };
  const std::pair along(2000.0f, 1000.0f);
  for (const char* frames : {"12", "12:13", "10:12:2", "13:12:-1", "12,3"}) {
    EXPECT_EQ(moves(frames, 12, "motion"), along) << frames;
    EXPECT_EQ(moves(frames, 12, "motion-next"), along) << frames;
  }
}

class FadingFilm : public Film {
 protected:
  /// A triangle before the camera that glows with so much radiance in frame 0, and as much in frame 6.
  std::string scene(float first, float last) const {
    scene::AnimatedFile file = scene::moving_triangle();
    file.root["materials"] = {
        {{"emissiveFactor", {1, 1, 1}},
         {"doubleSided", true},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1}}}}}}};
    file.root["meshes"][0]["primitives"][0]["material"] = 0;
    file.root["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_animation_pointer"};
    file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.1}, {"znear", 0.01}}}});
    file.node({{"camera", 0}, {"translation", {0.3, 0.3, 1}}});
    file.move("/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength",
              {file.seconds({0, 0.25f}), file.scalars({first, last})});
    return file.write(folder).string();
  }
  float exposure(const std::string& scene, const Words& more) const {
    render(scene, words_of("--exposure auto --spp 1 --environment none -o {} --stats {}",
                           {path("f-%d.png"), path("f-%d.json")}, more));
    return exposure_of("f-6.json");
  }
};

TEST_F(FadingFilm, IsShownWithOneExposureThatBlackFramesDoNotDecide) {
  const std::string film = scene(0.0f, 6.0f);
  // Radiances 1 to 6: their mean logarithm is that of 720^(1/6).
  const float expected = std::round(10.0f * std::log2(0.18f / std::pow(720.0f, 1.0f / 6.0f))) / 10.0f;
  for (const char* frames : {"0:6", "0:6:3", "3:6", "6", "6:0:-2"})
    EXPECT_EQ(exposure(film, {"--frames", frames, "--size", "16x9"}), expected) << frames;
  EXPECT_EQ(exposure(film, {"--frames", "6", "--size", "48x27", "--seed", "7", "--threads", "1"}), expected);
}

TEST_F(FadingFilm, ThatIsBlackIsShownAsItIs) {
  EXPECT_EQ(exposure(scene(0.0f, 0.0f), {"--frames", "6", "--size", "16x9"}), 0.0f);
}

}  // namespace
}  // namespace gatelight::tests
