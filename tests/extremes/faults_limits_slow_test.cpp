// Limits of memory, threads and sizes.

#include <fmt/format.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

using ::testing::AnyOf;
namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

class Limits : public Faults {
 protected:
  static Output run_within(rlim_t mebibytes, const Words& words) {
    return run_gatelight(words, [=] {
      const rlimit limit{mebibytes << 20, mebibytes << 20};
      ::setrlimit(RLIMIT_AS, &limit);
    });
  }
};

constexpr rlim_t kMinMebibytes = 384;

TEST_F(Limits, AddressSpaceLimitsEndInAPictureOrInOneErrorLine) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take terabytes of addresses";
  int pictures = 0;
  int refusals = 0;
  for (rlim_t mebibytes = kMinMebibytes; mebibytes <= 2560; mebibytes += 512) {
    for (const char* picture : {"--integrator path --size 4096x2048 --max-depth 1",
                                "--integrator nrc --size 64x64 --train-steps 8"}) {
      const Output output =
          run_within(mebibytes, square("-o {} --spp 1 --quiet", {path("a.exr")}, words_of(picture)));
      ASSERT_THAT(output.exit_code, AnyOf(0, 4)) << mebibytes << " MiB " << picture << ": " << output.err;
      ASSERT_FALSE(output.killed);
      if (output.exit_code == 0) {
        ++pictures;
      } else {
        ++refusals;
        expect_failure(output, 4, {"MiB"});
        EXPECT_EQ(fs::exists(path("a.exr")), false);
      }
      fs::remove(path("a.exr"));
    }
  }
  EXPECT_GT(pictures, 2);
  EXPECT_GT(refusals, 0);
}

/// A new control group below that of this process, where that is permitted.
class MemoryGroup {
 public:
  explicit MemoryGroup(std::size_t bytes) {
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
      const std::string name = "/gatelight-test-" + std::to_string(::getpid());
      if (line.find(":memory:") != std::string::npos) {
        try_at("/sys/fs/cgroup/memory" + line.substr(line.rfind(':') + 1) + name, "memory.limit_in_bytes",
               bytes);
      } else if (line.starts_with("0::")) {
        try_at("/sys/fs/cgroup" + line.substr(3) + name, "memory.max", bytes);
      }
    }
  }
  ~MemoryGroup() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove(folder_, ignored);
  }
  MemoryGroup(const MemoryGroup&) = delete;
  MemoryGroup& operator=(const MemoryGroup&) = delete;

  bool is_there() const { return !folder_.empty(); }
  /// Moves the calling process into the group.
  void enter() const { std::ofstream(folder_ + "/cgroup.procs") << ::getpid(); }

 private:
  void try_at(const std::string& folder, const char* limit, std::size_t bytes) {
    std::error_code error;
    if (!folder_.empty() || !fs::create_directory(folder, error)) return;
    std::ofstream(folder + "/" + limit) << bytes << std::flush;
    std::size_t set = 0;
    std::ifstream(folder + "/" + limit) >> set;
    if (set == bytes) {
      folder_ = folder;
    } else {
      fs::remove(folder, error);
    }
  }

  std::string folder_;
};

TEST_F(Limits, ControlGroupLimitsEndInAPictureOrInOneErrorLine) {
  int pictures = 0;
  int refusals = 0;
  for (std::size_t mebibytes = 64; mebibytes <= 320; mebibytes += 64) {
    const MemoryGroup group(mebibytes << 20);
    if (!group.is_there()) GTEST_SKIP() << "no control group for memory can be made here";
    const Output output =
        run_gatelight(square("-o {} --size 1024x1024 --spp 1 --quiet --max-depth 1", {path("a.exr")}),
                      [&] { group.enter(); });
    EXPECT_FALSE(output.killed) << mebibytes << " MiB";
    ASSERT_THAT(output.exit_code, AnyOf(0, 4)) << mebibytes << " MiB: " << output.err;
    (output.exit_code == 0 ? pictures : refusals) += 1;
    if (output.exit_code == 4) expect_failure(output, 4, {"MiB", "control group"});
  }
  EXPECT_GT(pictures, 0);
  EXPECT_GT(refusals, 0);
}

TEST_F(Limits, AThousandThreadsRenderThePictureOfOneThread) {
  for (const char* threads : {"1", "1000"})
    expect_done(
        run_gatelight(words_of("render {} --threads {} -o {} --size 64x64 --spp 4 --quiet "
                               "--reproducible --environment 1,1,1 --integrator nrc "
                               "--train-steps 16 --batch 1024",
                               {scene, threads, path(std::string(threads) + ".exr")})));
  EXPECT_TRUE(read_file(path("1.exr")) == read_file(path("1000.exr")));
  expect_failure(run_gatelight({"render", scene, "-o", path("a.exr"), "--threads", "1025"}), 1,
                 {"--threads", "1025"});
}

TEST_F(Limits, TheErrorNamesHowManyThreadsCanBeStarted) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take terabytes of addresses";
  for (const rlim_t mebibytes : {1024, 2048, 3072})
    expect_failure(
        run_within(mebibytes, words_of("render {} -o {} --size 16x16 --spp 1 --quiet --threads 1000",
                                       {scene, path("a.exr")})),
        4, {"--threads 1000"});
}

TEST_F(Limits, PictureSizesAreRefusedBeforeMemoryIsAllocated) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take terabytes of addresses";
  const auto render = [&](const char* size, const char* limit) {
    // Leaves a gibibyte to work in: a size that is not refused at once would not fit.
    return run_within(
        2048, square("-o {} --size {} --spp 1 --quiet --memory-limit {}", {path("a.exr"), size, limit}));
  };
  expect_failure(render("65536x65536", "0"), 1, {"4294967296", "268435456"});
  expect_failure(render("65536x4096", "1000"), 4, {"--memory-limit 1000"});
  expect_failure(render("65536x4096", "0"), 4, {"ulimit -v"});
  expect_done(render("65536x1", "0"));
  expect_done(render("1x65536", "0"));
}

}  // namespace
}  // namespace gatelight::tests
