// Frames of an animation through the real program.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

class Frames : public FolderTest {
 protected:
  /// The cache learns, and the denoiser carries light where it is installed.
  Output render(const Words& flags, const std::string& scene = "moving-room") const {
    return run_gatelight(words_of(
        "render {} --size 40x24 --spp 2 --preset standard --integrator nrc --reproducible --exr float",
        {GATELIGHT_SOURCE_DIR "/data/" + scene + ".glb"}, words_of(steps_, {}, flags)));
  }

  static Output render_plainly(const Words& flags) {
    return run_gatelight(
        words_of("render {} --size 40x24 --spp 2", {GATELIGHT_SOURCE_DIR "/data/moving-room.glb"}, flags));
  }

  void expect_same_file(const std::string& a, const std::string& b) const {
    EXPECT_TRUE(read_file(path(a)) == read_file(path(b))) << a << " and " << b;
  }

  std::string steps_ = "--train-steps 40";
};

TEST_F(Frames, AreTheSameForAnyThreadsAndAfterAResume) {
  expect_done(render({"--frames", "0:3", "--fps", "6", "-o", path("a-%d.exr"), "--threads", "2"}));
  const auto with = [&](const Words& flags) {
    return words_of("-o {} --threads 1 --fps 6 --checkpoint {}", {path("b-%d.exr"), path("state")}, flags);
  };
  // The first run makes only two of the frames. They are scouted with all that it makes, so all four are
  // named.
  expect_done(render(with({"--frames", "0:3", "--resume"})));
  for (const char* frame : {"0", "1", "2", "3"})
    expect_same_file(std::string("a-") + frame + ".exr", std::string("b-") + frame + ".exr");
  std::filesystem::remove(path("b-3.exr"));
  expect_done(render(with({"--frames", "0:3", "--resume"})));
  EXPECT_FALSE(std::filesystem::exists(path("b-3.exr"))) << "the state says that it is done";
}

/// Frame 2 of a run, alone after the cache of the frame before, and after a resume.
TEST_F(Frames, GoOnFromTheCacheOfTheFrameBeforeWithStepsThatAreChosen) {
  steps_.clear();
  const Output all = expect_done(
      render({"--frames", "0:2", "--fps", "6", "-o", path("a-%d.exr"), "--cache-out", path("cache-%d")}));
  expect_done(render({"--frames", "2:2", "--fps", "6", "-o", path("b.exr"), "--cache-in", path("cache-1")}));
  EXPECT_EQ(beauty_of(path("a-2.exr")), beauty_of(path("b.exr")))
      << "the headers differ: one names the cache";
  expect_done(render({"--frames", "0:2", "--fps", "6", "-o", path("c-%d.exr"), "--checkpoint",
                      path("cache-1"), "--resume"}));
  EXPECT_FALSE(std::filesystem::exists(path("c-1.exr")));
  expect_same_file("a-2.exr", "c-2.exr");
  const std::string printed = all.out + all.err;
  // 2^18 records are the least of a still, in batches of 2048.
  EXPECT_NE(printed.find("171 training steps"), std::string::npos) << "4/3 of 128\n" << printed;
  EXPECT_NE(printed.find("85 training steps"), std::string::npos) << printed;
}

TEST_F(Frames, WithoutACacheResumeToo) {
  const auto run = [&](const std::string& output, const Words& more) {
    return render_plainly(
        words_of("--denoiser auto --fps 6 --reproducible --exr float -o {}", {path(output)}, more));
  };
  expect_done(run("a-%d.exr", {"--frames", "0:2"}));
  expect_done(run("b-%d.exr", {"--frames", "0:1", "--checkpoint", path("state")}));
  expect_done(run("b-%d.exr", {"--frames", "0:2", "--checkpoint", path("state"), "--resume"}));
  expect_same_file("a-2.exr", "b-2.exr");
}

TEST_F(Frames, OfATurntableComeBack) {
  expect_done(render({"--turntable", "4", "--frames", "0:4:4", "--temporal", "off", "-o", path("t-%d.exr")},
                     "cornell-box"));
  EXPECT_FALSE(read_file(path("t-0.exr")) == read_file(path("t-4.exr"))) << "other random numbers";
}

TEST_F(Frames, AFailureOfOneDoesNotLoseTheOthers) {
  std::filesystem::create_directory(path("f-1.exr"));
  const Output run = render({"--frames", "0:2", "--fps", "6", "-o", path("f-%d.exr")});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("frame 1 failed: cannot write"), std::string::npos) << run.err;
  EXPECT_TRUE(std::filesystem::exists(path("f-0.exr")));
  EXPECT_TRUE(std::filesystem::exists(path("f-2.exr")));
}

TEST_F(Frames, AreShownWithOneExposure) {
  const auto run = [&](const Words& more) { return render_plainly(words_of("--fps 6", {}, more)); };
  expect_done(run({"--frames", "0:1", "--exposure", "auto", "-o", path("a-%d.png"), "--stats",
                   path("a-%d.json"), "--checkpoint", path("state")}));
  const auto exposure = [&](const char* file) {
    return nlohmann::json::parse(read_file(path(file)))["exposure"].get<float>();
  };
  EXPECT_NE(exposure("a-0.json"), 0.0f);
  EXPECT_EQ(exposure("a-1.json"), exposure("a-0.json"));
  const std::string stops = std::to_string(exposure("a-0.json"));
  expect_done(run({"--frames", "0:1", "--exposure", stops, "-o", path("b-%d.png")}));
  expect_same_file("a-1.png", "b-1.png");
  expect_done(run({"--frames", "0:2", "--exposure", "auto", "-o", path("a-%d.png"), "--stats",
                   path("a-%d.json"), "--checkpoint", path("state"), "--resume"}));
  EXPECT_EQ(exposure("a-2.json"), exposure("a-0.json"));
}

TEST_F(Frames, ThatAreThereStayAsTheyAre) {
  const auto run = [&](const Words& more) {
    return render_plainly(
        words_of("--reproducible -o {} -o {}", {path("shot_%02d/f.exr"), path("f-%d.png")}, more));
  };
  expect_done(run({"--frames", "1,3-4"}));
  const std::string third = read_file(path("shot_03/f.exr"));
  folder.write("shot_01/f.exr", "kept");
  folder.write("f-4.png", "");
  std::filesystem::remove(path("shot_03/f.exr"));
  const Output rest = expect_done(run({"--frames", "1,3-4", "--skip-existing"}));
  EXPECT_NE(rest.err.find("skipped   1 of 3"), std::string::npos) << rest.err;
  EXPECT_EQ(read_file(path("shot_01/f.exr")), "kept");
  EXPECT_TRUE(read_file(path("shot_03/f.exr")) == third);
  EXPECT_GT(std::filesystem::file_size(path("f-4.png")), 0u) << "an empty file is no picture";
  const Output none = expect_done(run({"--frames", "1,3-4", "--skip-existing"}));
  EXPECT_NE(none.err.find("skipped   3 of 3"), std::string::npos) << none.err;
  EXPECT_EQ(read_file(path("shot_01/f.exr")), "kept");
}

TEST_F(Frames, OfAllCamerasAreThoseOfEach) {
  const auto run = [&](const std::string& camera, const std::string& output) {
    return run_gatelight(
        words_of("render {} --size 32x18 --spp 1 --reproducible --turntable 2 --camera {} -o {}",
                 {GATELIGHT_SOURCE_DIR "/data/teapot-stadium.glb", camera, path(output)}));
  };
  expect_done(run("all", "{camera}-%d.exr"));
  expect_done(run("hall", "alone-%d.exr"));
  for (const char* frame : {"0", "1"}) {
    EXPECT_EQ(beauty_of(path(std::string("hall-") + frame + ".exr")),
              beauty_of(path(std::string("alone-") + frame + ".exr")));
    EXPECT_TRUE(std::filesystem::exists(path(std::string("teapot-") + frame + ".exr")));
  }
}

TEST_F(Frames, TellTheirProgress) {
  const Output told = expect_done(render({"--frames", "0:1", "-o", path("f-%d.exr"), "--progress", "json"}));
  for (const char* text : {"\"event\":\"frame\"", "\"frame\":1", "\"frames\":2", "\"event\":\"done\""})
    EXPECT_NE(told.err.find(text), std::string::npos) << text << "\n" << told.err;
}

}  // namespace
}  // namespace gatelight::tests
