// Renders that are stopped and resumed.

#include <signal.h>

#include "renderer/image/image_read.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

class Stopped : public Faults {
 protected:
  std::vector<std::string> learning(const std::string& output, const std::vector<std::string>& more) const {
    std::vector<std::string> all =
        words({"-o", path(output), "--size", "48x48", "--spp", "4", "--integrator", "nrc", "--train-steps",
               "3000", "--batch", "1024", "--progress", "json", "--reproducible"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(Stopped, TerminationDuringTrainingKeepsPictureAndCheckpoint) {
  const std::vector<std::string> keeps = {"--checkpoint", path("c"), "--resume"};
  Process process(learning("killed.exr", keeps));
  ASSERT_TRUE(process.wait_for_error_text("\"train\""));
  process.send(SIGTERM);
  const Output output = process.finish();
  EXPECT_EQ(output.exit_code, 143) << output.err;
  EXPECT_FALSE(output.killed);
  expect_message(output.last_error_line(), {"3000", "--resume"});
  EXPECT_EQ(renderer::read_image(path("killed.exr")).width, 48);
  EXPECT_EQ(folder.count_files(), 3u) << "a temporary file is left";
  expect_done(run_gatelight(learning("killed.exr", keeps)));
  expect_done(run_gatelight(learning("straight.exr", {})));
  EXPECT_EQ(read_file(path("killed.exr")) == read_file(path("straight.exr")), true);
}

TEST_F(Stopped, ResumingWithAnotherSceneIsRefused) {
  const std::vector<std::string> keeps = {"--checkpoint", path("c"), "--resume"};
  const std::string now = tiny_scene();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = now;
    text.replace(text.find(from), from.size(), to);
    folder.write("scene.gltf", text);
    std::vector<std::string> all = words({"-o", path("a.exr"), "--size", "16x16", "--spp", "2", "--quiet"});
    all.insert(all.end(), keeps.begin(), keeps.end());
    return run_gatelight(all);
  };
  expect_done(changed("\"asset\"", "\"asset\""));
  const std::string kept = read_file(path("c"));
  expect_failure(changed("[0.5, 0.5, 0.5, 1]", "[0.5, 0.25, 0.5, 1]"), 2, {"materials"});
  expect_failure(changed("AACAvwAAgL8", "AACAPwAAgL8"), 2, {"geometry"});
  expect_failure(changed("\"metallicFactor\": 0", "\"metallicFactor\": 1"), 2, {"materials"});
  expect_failure(changed("\"yfov\": 0.9", "\"yfov\": 0.8"), 2, {"camera"});
  EXPECT_EQ(read_file(path("c")) == kept, true);
  expect_done(changed("\"asset\"", "\"asset\""));
}

}  // namespace
}  // namespace gatelight::tests
