// Signals to a real render.

#include <gtest/gtest.h>

#include <signal.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "renderer/image/image_read.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

class Signals : public FolderTest {
 protected:
  /// Arguments of a render that would take days.
  std::vector<std::string> endless() const {
    return {"render",        scene,   "-o",      path("a.exr"),  "-o",        path("b.png"),
            "--environment", "1,1,1", "--size",  "64x64",        "--spp",     "16777216",
            "--progress",    "json",  "--stats", path("s.json"), "--threads", "1"};
  }

  std::string scene = folder.write("scene.gltf", tiny_scene());
};

TEST_F(Signals, InterruptAndTerminateWriteThePictureSoFar) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // It may be ignored here, under nohup.
    Process process(endless(), [] { ::signal(SIGHUP, SIG_DFL); });
    ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
    process.send(signal);
    const Output output = process.finish();
    EXPECT_FALSE(output.killed);
    EXPECT_EQ(output.exit_code, 128 + signal) << output.err;
    EXPECT_EQ(output.out, "");
    expect_message(output.last_error_line(), {"signal " + std::to_string(signal), "a.exr"});
    EXPECT_EQ(renderer::read_image(path("a.exr")).width, 64);
    EXPECT_EQ(renderer::read_image(path("b.png")).width, 64);
    const nlohmann::json stats = nlohmann::json::parse(read_file(path("s.json")));
    EXPECT_EQ(stats["interrupted"], true);
    EXPECT_EQ(stats["signal"], signal);
    EXPECT_GE(stats["spp"], 1);
    EXPECT_EQ(folder.count_files(), 4u) << "a temporary file is left";
    for (const char* name : {"a.exr", "b.png", "s.json"}) std::filesystem::remove(path(name));
  }
}

TEST_F(Signals, StatisticsOfResumedRunsAddUp) {
  Words arguments = endless();
  arguments.insert(arguments.end(), {"--checkpoint", path("k"), "--resume"});
  Process process(arguments);
  ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
  process.send(SIGINT);
  ASSERT_EQ(process.finish().exit_code, 130);
  const nlohmann::json first = nlohmann::json::parse(read_file(path("s.json")));
  EXPECT_FALSE(first["seconds"].contains("render_resumed"));
  const int spp = first["spp"].get<int>() + 4;
  std::replace(arguments.begin(), arguments.end(), std::string("16777216"), std::to_string(spp));
  std::replace(arguments.begin(), arguments.end(), std::string("json"), std::string("none"));
  const Output resumed = expect_done(run_gatelight(arguments));
  const nlohmann::json both = nlohmann::json::parse(read_file(path("s.json")));
  EXPECT_EQ(both["spp"], spp);
  EXPECT_EQ(both["samples"], 64 * 64 * spp);
  EXPECT_EQ(both["rays"]["camera"], both["samples"]) << "those of the first run too";
  // The checkpoint has the seconds of its last whole pass.
  EXPECT_NEAR(both["seconds"]["render_resumed"].get<double>(), first["seconds"]["render"].get<double>(),
              0.05);
  EXPECT_GT(both["seconds"]["render"], both["seconds"]["render_resumed"]);
  EXPECT_NE(resumed.err.find("of them before --resume"), std::string::npos) << resumed.err;
}

TEST_F(Signals, AHangupThatIsIgnoredStaysIgnored) {
  Process process(endless(), [] { ::signal(SIGHUP, SIG_IGN); });
  ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
  process.send(SIGHUP);
  process.send(SIGTERM);
  EXPECT_EQ(process.finish().exit_code, 128 + SIGTERM);
}

TEST_F(Signals, ASecondInterruptEndsTheProgramAtOnce) {
  Words arguments = endless();
  // A pass of four million samples on one thread is not finished in between.
  std::replace(arguments.begin(), arguments.end(), std::string("64x64"), std::string("2048x2048"));
  Process process(arguments);
  ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
  process.send(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  process.send(SIGINT);
  const Output output = process.finish();
  EXPECT_TRUE(output.killed);
  EXPECT_EQ(output.exit_code, 130);
  EXPECT_EQ(folder.count_files(), 1u) << "only the scene";
}

TEST_F(Signals, User1WritesASnapshotAndTheRunGoesOn) {
  Process process(endless());
  ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
  ASSERT_FALSE(std::filesystem::exists(path("a.exr")));
  process.send(SIGUSR1);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(path("b.png")) && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(renderer::read_image(path("a.exr")).width, 64);
  EXPECT_EQ(renderer::read_image(path("b.png")).width, 64);
  EXPECT_FALSE(std::filesystem::exists(path("s.json")));
  process.send(SIGINT);
  EXPECT_EQ(process.finish().exit_code, 130);
}

}  // namespace
}  // namespace gatelight::tests
