// A render that is killed again and again ends with the file of one that was not.

#include <gtest/gtest.h>

#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <thread>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::tests {
namespace {

using std::chrono::microseconds;

struct Kill {
  const char* name;
  Words arguments;
};

/// Inode of the file. It changes with each write, because files are renamed into place.
ino_t identity(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

void PrintTo(const Kill& kill, std::ostream* stream) {
  *stream << kill.name;
}

class Killed : public ::testing::TestWithParam<Kill> {
 protected:
  std::vector<std::string> command(const std::string& output, const char* threads) const {
    Words words =
        words_of("render {} -o {} --threads {} --size 96x96 --exr float --quiet --reproducible",
                 {GATELIGHT_SOURCE_DIR "/data/cornell-box.glb", (folder / output).string(), threads});
    words.insert(words.end(), GetParam().arguments.begin(), GetParam().arguments.end());
    return words;
  }

  TemporaryFolder folder;
};

TEST_P(Killed, ResumingAfterKillsAtAnyMomentGivesTheSameBytes) {
  expect_done(run_gatelight(command("straight.exr", "2")));
  const std::string checkpoint = (folder / "checkpoint").string();
  Words words = command("killed.exr", "1");
  for (const char* word : {"--checkpoint", checkpoint.c_str(), "--checkpoint-every", "0", "--resume"})
    words.emplace_back(word);
  int killed = 0;
  for (int i = 0; i < 5; ++i) {
    ino_t before = identity(checkpoint);
    Process process(words);
    // Some moment after one or more new checkpoints: mostly the next one is being written.
    for (int seen = 0; seen < 1 + i % 3 && process.runs(); std::this_thread::sleep_for(microseconds(200))) {
      const ino_t now = identity(checkpoint);
      seen += now != before ? 1 : 0;
      before = now;
    }
    std::this_thread::sleep_for(microseconds(1700 * i));
    process.send(SIGKILL);
    const Output output = process.finish();
    if (!output.killed) {
      EXPECT_EQ(output.exit_code, 0) << output.err;
      break;
    }
    ++killed;
  }
  EXPECT_GT(killed, 1);
  expect_done(run_gatelight(words));
  EXPECT_EQ(read_file(folder / "killed.exr") == read_file(folder / "straight.exr"), true);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Killed,
                         ::testing::Values(Kill{"path", {"--integrator", "path", "--spp", "64"}},
                                           Kill{"light_groups",
                                                {"--integrator", "path", "--spp", "64", "--environment",
                                                 "0.2,0.2,0.2", "--light-groups", "sky=environment"}},
                                           Kill{"nrc",
                                                {"--integrator", "nrc", "--spp", "24", "--train-steps", "24",
                                                 "--batch", "2048"}}),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace gatelight::tests
