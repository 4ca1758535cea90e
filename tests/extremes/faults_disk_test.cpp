// Errors of disks and pipes: full, read-only, removed.

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <linux/capability.h>

#include "renderer/image/image_read.h"
#include "tests/extremes/faults.h"

namespace gatelight::tests {
namespace {

class FaultyDisk : public Faults {};

const Words kKinds = {"a.exr", "a.png", "stats.json", "checkpoint", "cache"};

/// Arguments of a render whose output of one kind is at `place`, with a picture at `other`.
Words outputs(const std::string& kind, const std::string& place, const std::string& other) {
  if (kind == "a.exr" || kind == "a.png") return {"-o", place, "-o", other};
  if (kind == "stats.json") return {"-o", other, "--stats", place};
  if (kind == "checkpoint") return {"-o", other, "--checkpoint", place, "--checkpoint-every", "0"};
  return words_of("-o {} --integrator nrc --train-steps 8 --batch 512 --cache-out {}", {other, place});
}

/// Root writes everywhere by a capability, which a program loses that is run without it.
void drop_capability() {
  ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0);
}

/// The writing end of a pipe without a reader.
int broken_pipe() {
  int ends[2];
  if (::pipe(ends) != 0) ::_exit(126);
  ::close(ends[0]);
  return ends[1];
}

TEST_F(FaultyDisk, AFullDiskKeepsTheOldFileAndLeavesNoTemporaryFile) {
  // Only this process and its children see the disk.
  if (::unshare(CLONE_NEWNS) != 0) GTEST_SKIP() << "mounting is not permitted here";
  const std::string disk = path("disk");
  std::filesystem::create_directory(disk);
  ASSERT_EQ(::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr), 0);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=8k") != 0)
    GTEST_SKIP() << "mounting is not permitted here";
  std::ofstream(disk + "/filler") << std::string(4096, 'x');
  for (const std::string& kind : kKinds) {
    const std::string place = disk + "/" + kind;
    std::ofstream(place) << "old";
    const std::string other = path("other.exr");
    const Output output =
        run_gatelight(square("--size 64x64 --spp 2 --quiet", {}, outputs(kind, place, other)));
    EXPECT_EQ(output.exit_code, 3) << kind << output.err;
    EXPECT_FALSE(output.killed) << kind;
    expect_message(output.last_error_line(), {place});
    EXPECT_EQ(read_file(place), "old") << kind;
    EXPECT_EQ(renderer::read_image(other).width, 64) << kind;
    std::filesystem::remove(place);
    std::filesystem::remove(other);
    std::size_t left = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(disk)) ++left;
    EXPECT_EQ(left, 1u) << kind << ": a temporary file is left";
  }
  ::umount(disk.c_str());
}

TEST_F(FaultyDisk, AFileSizeLimitActsLikeAFullDisk) {
  for (const std::string& kind : kKinds) {
    folder.write("disk/" + kind, "old");
    // Statistics and the picture beside a checkpoint are smaller than both limits.
    const rlim_t bytes = kind == "checkpoint" || kind == "cache" ? 40000 : 1000;
    const Words words = outputs(kind, path("disk/" + kind), path("other.exr"));
    const Output output = run_gatelight(square("--size 64x64 --spp 2 --quiet", {}, words), [&] {
      const rlimit limit{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    });
    EXPECT_EQ(output.exit_code, 3) << kind << output.err;
    EXPECT_FALSE(output.killed) << kind;
    // Statistics fit, the picture beside them does not.
    expect_message(output.last_error_line(), {path(kind == "stats.json" ? "other.exr" : "disk/" + kind)});
    EXPECT_EQ(read_file(path("disk/" + kind)), "old") << kind;
    if (bytes > 1000) {
      EXPECT_EQ(renderer::read_image(path("other.exr")).width, 64) << kind;
    }
    std::filesystem::remove(path("other.exr"));
  }
  EXPECT_EQ(folder.count_files(), 2u) << "a temporary file is left";
}

TEST_F(FaultyDisk, AReadOnlyFolderOrFileIsRefusedBeforeTheWork) {
  const std::filesystem::path locked = folder / "locked";
  std::filesystem::create_directory(locked);
  std::filesystem::permissions(locked, std::filesystem::perms(0555));
  for (const std::string& kind : kKinds) {
    const auto refused = [&](const std::string& place) {
      return run_gatelight(
          square("--size 4096x4096 --spp 65536 --quiet", {}, outputs(kind, place, path("other.exr"))),
          drop_capability);
    };
    expect_failure(refused((locked / kind).string()), 3, {locked.string()});
    const std::string kept = folder.write(kind, "a reference of last year");
    std::filesystem::permissions(kept, std::filesystem::perms(0444));
    expect_failure(refused(kept), 3, {kept});
    EXPECT_EQ(read_file(kept), "a reference of last year");
  }
  std::filesystem::permissions(locked, std::filesystem::perms(0755));
  expect_failure(run_gatelight(square("-o {} --quiet", {scene + "/a.exr"})), 3, {scene});
}

TEST_F(FaultyDisk, ARemovedFolderLosesOnlyItsOwnOutputs) {
  std::filesystem::create_directory(folder / "gone");
  Process process(
      square("-o {} -o {} --checkpoint {} --checkpoint-every 0 --size 64x64 --spp 16777216 "
             "--progress json",
             {path("gone/a.exr"), path("stays.exr"), path("gone/c")}));
  ASSERT_TRUE(process.wait_for_error_text("\"progress\""));
  std::filesystem::remove_all(folder / "gone");
  ASSERT_TRUE(process.wait_for_error_text("the write will be retried"));
  process.send(SIGTERM);
  const Output output = process.finish();
  EXPECT_EQ(output.exit_code, 3) << output.err;
  expect_message(output.last_error_line(), {path("gone")});
  EXPECT_EQ(renderer::read_image(path("stays.exr")).width, 64);
  EXPECT_EQ(folder.count_files(), 2u);
}

TEST_F(FaultyDisk, AnUnwritableStderrIsIgnoredAndAnUnwritableStdoutIsCode3) {
  const auto full = [] { return ::open("/dev/full", O_WRONLY); };
  for (const std::function<int()>& open : {std::function<int()>(full), std::function<int()>(broken_pipe)}) {
    std::filesystem::remove(path("a.exr"));
    expect_done(run_gatelight(square("-o {} --size 16x16 --spp 2 --progress json --verbose", {path("a.exr")}),
                              [&] { ::dup2(open(), STDERR_FILENO); }));
    EXPECT_EQ(renderer::read_image(path("a.exr")).width, 16);
    expect_failure(run_gatelight(square("-o {} --size 16x16 --spp 2 --quiet --stats -", {path("a.exr")}),
                                 [&] { ::dup2(open(), STDOUT_FILENO); }),
                   3, {"stdout"});
  }
}

}  // namespace
}  // namespace gatelight::tests
