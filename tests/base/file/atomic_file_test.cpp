#include "base/file/atomic_file.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight {
namespace {

using tests::expect_message;
using tests::read_file;
using tests::TemporaryFolder;
namespace fs = std::filesystem;

std::string refusal(const fs::path& path) {
  return tests::refusal<OutputError>([&] { check_writable(path); });
}

void expect_refused(const fs::path& path) {
  expect_message(refusal(path), {path.string()});
}

TEST(AtomicFile, WithoutCommitTheOldFileStaysAndNothingIsLeft) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  {
    AtomicFile file(folder / "a.txt");
    file.write("new", 3);
    EXPECT_EQ(read_file(folder / "a.txt"), "old");
    EXPECT_LE(folder.count_files(), 2u);
  }
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(AtomicFile, CommitReplacesTheWholeFile) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old and long");
  write_file_atomically(folder / "a.txt", "new");
  EXPECT_EQ(read_file(folder / "a.txt"), "new");
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(AtomicFile, AKilledProgramLeavesNoFile) {
  const TemporaryFolder folder;
  const int nameless = ::open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600);
  if (nameless < 0) GTEST_SKIP() << "the file system does not support O_TMPFILE";
  ::close(nameless);
  folder.write("a.txt", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(folder / "a.txt");
    file.write("new", 3);
    std::fflush(file.stream());
    std::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(folder.count_files(), 1u);
  EXPECT_EQ(read_file(folder / "a.txt"), "old");
}

TEST(AtomicFile, PermissionsFollowTheUmask) {
  const TemporaryFolder folder;
  const mode_t before = ::umask(027);
  write_file_atomically(folder / "a.txt", "x");
  ::umask(before);
  EXPECT_EQ(fs::status(folder / "a.txt").permissions(), fs::perms(0640));
}

TEST(AtomicFile, ALinkIsFollowedAndStays) {
  const TemporaryFolder folder;
  folder.write("target.txt", "old");
  fs::create_symlink("target.txt", folder / "link.txt");
  write_file_atomically(folder / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_file(folder / "target.txt"), "new");
}

TEST(AtomicFile, ALinkToAMissingFileIsFollowedToo) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "there");
  fs::create_symlink("there/next", folder / "link.txt");
  fs::create_symlink(folder / "there/target.txt", folder / "there/next");
  write_file_atomically(folder / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_file(folder / "there/target.txt"), "new");
  fs::create_symlink("no such folder/a.txt", folder / "lost.txt");
  expect_refused(folder / "lost.txt");
  fs::create_symlink("loop.txt", folder / "loop.txt");
  expect_refused(folder / "loop.txt");
}

TEST(AtomicFile, TheLongestNameCanBeReplaced) {
  const TemporaryFolder folder;
  const fs::path path = folder / std::string(255, 'n');
  for (const char* text : {"first", "second"}) {
    write_file_atomically(path, text);
    EXPECT_EQ(read_file(path), text);
  }
}

TEST(CheckWritable, NamesTheObstacle) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  fs::create_directory(folder / "folder");
  EXPECT_EQ(refusal(folder / "free"), "");
  EXPECT_EQ(refusal(folder / "file"), "");
  for (const char* name : {"folder", "file/below", "missing/below"}) expect_refused(folder / name);
  expect_refused("/dev/null");
  expect_message(refusal(""), {});
}

TEST(CheckWritable, RefusesAReadOnlyFolder) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  expect_refused(folder / "a");
  fs::permissions(folder.path(), fs::perms::owner_all);
}

}  // namespace
}  // namespace gatelight
