// Films of frames through the real program, with a script in place of ffmpeg.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

namespace fs = std::filesystem;

/// Keeps its arguments and input, and copies the input as the film, its last argument.
constexpr const char* kEncoder = R"(#!/bin/sh
here=$(dirname "$0")
printf '%s\n' "$@" > "$here/arguments"
for last; do :; done
cat > "$here/pixels"
cp "$here/pixels" "${last#file:}"
)";

class PreviewVideo : public FolderTest {
 protected:
  void use_encoder(const std::string& script) const {
    const fs::path file = folder.write("bin/ffmpeg", script);
    fs::permissions(file, fs::perms::owner_all);
  }

  Output render(const std::vector<std::string>& flags, const std::string& size = "9x5",
                const std::string& path_variable = "") const {
    std::vector<std::string> words = {
        "render", GATELIGHT_SOURCE_DIR "/data/moving-room.glb", "--spp", "2", "--fps", "6", "--size", size};
    words.insert(words.end(), flags.begin(), flags.end());
    const std::string bin = path_variable.empty() ? path("bin") + ":/usr/bin:/bin" : path_variable;
    return run_gatelight(words, [&] { ::setenv("PATH", bin.c_str(), 1); });
  }

  /// The frame's pixels as the film has them: even numbers of columns and rows.
  std::string film_bytes(const std::string& png) const {
    const renderer::Picture picture = renderer::read_image(path(png));
    const std::vector<std::uint8_t> rgb = renderer::display_bytes(picture);
    std::string bytes;
    for (int y = 0; y < picture.height + picture.height % 2; ++y) {
      for (int x = 0; x < picture.width + picture.width % 2; ++x) {
        const int pixel = std::min(y, picture.height - 1) * picture.width + std::min(x, picture.width - 1);
        for (int c = 0; c < 3; ++c)
          bytes.push_back(static_cast<char>(rgb[static_cast<std::size_t>(3 * pixel + c)]));
      }
    }
    return bytes;
  }

  /// Whether the folder has a file that begins with a dot.
  bool has_rest() const {
    for (const auto& entry : fs::directory_iterator(folder.path())) {
      if (entry.path().filename().string().starts_with(".")) return true;
    }
    return false;
  }
};

TEST_F(PreviewVideo, HasTheFramesInTheirOrder) {
  use_encoder(kEncoder);
  const Output run = render({"--frames", "4:0:-2", "-o", path("f-%d.png"), "-o", path("f-%d.exr"),
                             "--preview-video", path("-a b.mp4")});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("film      3 frames"), std::string::npos) << run.err;
  EXPECT_TRUE(read_file(path("-a b.mp4")) ==
              film_bytes("f-4.png") + film_bytes("f-2.png") + film_bytes("f-0.png"));
  const std::string arguments = "\n" + read_file(path("bin/arguments"));
  EXPECT_NE(arguments.find("\n-video_size\n10x6\n-framerate\n3\n-i\npipe:0\n"), std::string::npos)
      << arguments;
  EXPECT_NE(arguments.find("\n-f\nmp4\nfile:" + path("")), std::string::npos) << arguments;
  EXPECT_FALSE(has_rest());
}

TEST_F(PreviewVideo, OfRadianceIsShownAsPngWouldBe) {
  use_encoder(kEncoder);
  const std::vector<std::string> shown = {"--frames", "0:1", "--exposure", "auto", "--tonemap", "agx"};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), shown.begin(), shown.end());
    return render(more);
  };
  ASSERT_EQ(run({"-o", path("f-%d.exr"), "--exr", "float", "--preview-video", path("film.gif")}).exit_code,
            0);
  ASSERT_EQ(run({"-o", path("f-%d.png"), "--preview-video", path("png.gif")}).exit_code, 0);
  EXPECT_TRUE(read_file(path("film.gif")) == read_file(path("png.gif")));
  EXPECT_EQ(read_file(path("film.gif")).size(), 2u * 3u * 9u * 5u) << "no pixels are added";
}

TEST_F(PreviewVideo, HasBlackBehindAlpha) {
  use_encoder(kEncoder);
  const auto run = [&](const std::string& output) {
    return render({"--frames", "0", "--background", "transparent", "--eye", "0,30,30", "--target", "0,0,0",
                   "-o", path(output), "--preview-video", path("film.gif")});
  };
  const Output first = run("f.png");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const renderer::Picture picture = renderer::read_image(path("f.png"));
  ASSERT_TRUE(picture.layers.front().has_alpha());
  ASSERT_EQ(picture.layers.front().values[3], 0.0f);
  EXPECT_EQ(read_file(path("film.gif")).substr(0, 3), std::string(3, '\0'));
}

TEST_F(PreviewVideo, HasFramesOfEarlierRuns) {
  use_encoder(kEncoder);
  const std::vector<std::string> words = {"-o", path("f-%d.png"), "--checkpoint", path("state")};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.end(), words.begin(), words.end());
    return render(more);
  };
  ASSERT_EQ(run({"--frames", "0:2"}).exit_code, 0);
  ASSERT_EQ(run({"--frames", "0:3", "--resume", "--preview-video", path("film.mkv")}).exit_code, 0);
  std::string all;
  for (const char* frame : {"f-0.png", "f-1.png", "f-2.png", "f-3.png"}) all += film_bytes(frame);
  EXPECT_TRUE(read_file(path("film.mkv")) == all);
  // All are done, and one is gone.
  fs::remove(path("f-1.png"));
  const Output again = run({"--frames", "0:3", "--resume", "--preview-video", path("film.mkv")});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  expect_messages(again.warnings(), {{"film", "frame 1", "f-1.png"}});
  EXPECT_TRUE(read_file(path("film.mkv")) ==
              film_bytes("f-0.png") + film_bytes("f-2.png") + film_bytes("f-3.png"));
}

TEST_F(PreviewVideo, LeavesOutFramesThatFailed) {
  use_encoder(kEncoder);
  fs::create_directory(path("f-1.png"));
  const Output run = render({"--frames", "0:2", "-o", path("f-%d.png"), "--preview-video", path("film.mov")});
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_EQ(run.warnings().size(), 1u) << run.err;
  EXPECT_TRUE(read_file(path("film.mov")) == film_bytes("f-0.png") + film_bytes("f-2.png"));
}

TEST_F(PreviewVideo, WithoutAnEncoderIsRefusedBeforeTheFirstFrame) {
  fs::create_directory(path("bin"));
  const Output run = render({"--frames", "0:2", "-o", path("f-%d.png"), "--preview-video", path("film.mp4")},
                            "9x5", path("bin"));
  expect_failure(run, 5, {"--preview-video", "ffmpeg", "PATH", "PNG"});
  EXPECT_FALSE(fs::exists(path("f-0.png")));
}

TEST_F(PreviewVideo, ThatFailsKeepsTheFramesAndTheOldFilm) {
  folder.write("film.mp4", "old");
  const auto run = [&](const std::string& script, const std::string& size) {
    use_encoder(script);
    return render({"--quiet", "--frames", "0:2", "-o", path("f-%d.png"), "--preview-video", path("film.mp4")},
                  size);
  };
  const std::string talks = "#!/bin/sh\necho one >&2\necho 'no codec is there' >&2\n";
  // Pictures that fit in the pipe, and others that do not.
  for (const char* size : {"9x5", "200x150"})
    expect_failure(run(talks + "exit 1\n", size), 3, {"film.mp4", "ffmpeg", "no codec is there"});
  expect_failure(run("#!/bin/sh\ncat > /dev/null\nexit 7\n", "9x5"), 3, {"film.mp4", "ffmpeg", "7"});
  expect_failure(run("#!/bin/sh\nkill -9 $$\n", "9x5"), 3, {"film.mp4", "ffmpeg", "9"});
  EXPECT_EQ(run("not a program\n", "9x5").exit_code, 3);
  EXPECT_EQ(read_file(path("film.mp4")), "old");
  EXPECT_TRUE(fs::exists(path("f-2.png")));
  EXPECT_FALSE(has_rest());
}

TEST_F(PreviewVideo, ThatIsStoppedIsNotThere) {
  use_encoder("#!/bin/sh\nexec sleep 60\n");
  const std::string bin = path("bin") + ":/usr/bin:/bin";
  Process process(
      {"render", GATELIGHT_SOURCE_DIR "/data/moving-room.glb", "--spp", "1", "--size", "200x150", "--frames",
       "0:1", "-o", path("f-%d.png"), "--progress", "json", "--preview-video", path("film.mp4")},
      [&] { ::setenv("PATH", bin.c_str(), 1); });
  ASSERT_TRUE(process.wait_for_error_text("\"phase\":\"film\""));
  process.send(SIGTERM);
  const Output run = process.finish();
  EXPECT_EQ(run.exit_code, 143) << run.err;
  EXPECT_FALSE(run.killed);
  EXPECT_FALSE(fs::exists(path("film.mp4")));
  EXPECT_TRUE(fs::exists(path("f-1.png")));
  EXPECT_FALSE(has_rest());
}

}  // namespace
}  // namespace gatelight::tests
