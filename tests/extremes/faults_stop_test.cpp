// Renders that are stopped and resumed.

#include <signal.h>

#include "renderer/image/image_read.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

class Stopped : public Faults {
 protected:
  Words learning(const std::string& output, const Words& more) const {
    return square(
        "-o {} --size 48x48 --spp 4 --integrator nrc --train-steps 3000 --batch 1024 --progress json "
        "--reproducible",
        {path(output)}, more);
  }
};

TEST_F(Stopped, TerminationDuringTrainingKeepsPictureAndCheckpoint) {
  const Words keeps = words_of("--checkpoint {} --resume --cache-out {}", {path("c"), path("c.safetensors")});
  Process process(learning("killed.exr", keeps));
  ASSERT_TRUE(process.wait_for_error_text("\"train\""));
  process.send(SIGTERM);
  const Output output = process.finish();
  EXPECT_EQ(output.exit_code, 143) << output.err;
  EXPECT_FALSE(output.killed);
  expect_message(output.last_error_line(), {"3000", "killed.exr", "--resume", path("c.safetensors")});
  EXPECT_EQ(renderer::read_image(path("killed.exr")).width, 48);
  EXPECT_EQ(folder.count_files(), 3u) << "a temporary file is left, or part of a cache";
  expect_done(run_gatelight(learning("killed.exr", keeps)));
  expect_done(run_gatelight(learning("straight.exr", {})));
  EXPECT_TRUE(read_file(path("killed.exr")) == read_file(path("straight.exr")));
}

TEST_F(Stopped, ResumingWithAnotherSceneIsRefused) {
  const std::string now = tiny_scene();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = now;
    text.replace(text.find(from), from.size(), to);
    folder.write("scene.gltf", text);
    return run_gatelight(
        square("-o {} --size 16x16 --spp 2 --quiet --checkpoint {} --resume", {path("a.exr"), path("c")}));
  };
  expect_done(changed("\"asset\"", "\"asset\""));
  const std::string kept = read_file(path("c"));
  expect_failure(changed("AACAvwAAgL8", "AACAPwAAgL8"), 2, {"geometry"});
  expect_failure(changed("\"metallicFactor\": 0", "\"metallicFactor\": 1"), 2, {"materials"});
  expect_failure(changed("\"yfov\": 0.9", "\"yfov\": 0.8"), 2, {"camera"});
  EXPECT_TRUE(read_file(path("c")) == kept);
  expect_done(changed("\"asset\"", "\"asset\""));
}

}  // namespace
}  // namespace gatelight::tests
