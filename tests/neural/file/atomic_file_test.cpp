#include "neural/file/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/support/temporary_folder.h"

namespace gatelight::neural {
namespace {

using ::testing::HasSubstr;
using tests::read_file;
using tests::TemporaryFolder;
namespace fs = std::filesystem;

std::string refusal(const fs::path& path) {
  try {
    check_writable(path);
  } catch (const OutputError& error) {
    return error.what();
  }
  return "";
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

TEST(AtomicFile, CommitReplacesTheWhole) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old and long");
  write_file_atomically(folder / "a.txt", "new");
  EXPECT_EQ(read_file(folder / "a.txt"), "new");
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST(AtomicFile, OfAKilledProgramNothingIsLeft) {
  const TemporaryFolder folder;
  const int nameless = ::open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600);
  if (nameless < 0) GTEST_SKIP() << "the file system has no files without a name";
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

TEST(AtomicFile, PermissionsAreThoseOfTheUmask) {
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

TEST(AtomicFile, ALinkToWhatIsNotThereYetIsFollowedToo) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "there");
  fs::create_symlink("there/next", folder / "link.txt");
  fs::create_symlink(folder / "there/target.txt", folder / "there/next");
  write_file_atomically(folder / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
  EXPECT_EQ(read_file(folder / "there/target.txt"), "new");
  fs::create_symlink("no such folder/a.txt", folder / "lost.txt");
  EXPECT_THAT(refusal(folder / "lost.txt"), HasSubstr("does not exist"));
  fs::create_symlink("loop.txt", folder / "loop.txt");
  EXPECT_THAT(refusal(folder / "loop.txt"), HasSubstr("loop.txt"));
}

TEST(AtomicFile, TheLongestNameCanBeReplaced) {
  const TemporaryFolder folder;
  const fs::path path = folder / std::string(255, 'n');
  for (const char* text : {"first", "second"}) {
    write_file_atomically(path, text);
    EXPECT_EQ(read_file(path), text);
  }
}

TEST(CheckWritable, NamesWhatStandsInTheWay) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  fs::create_directory(folder / "folder");
  EXPECT_EQ(refusal(folder / "free"), "");
  EXPECT_EQ(refusal(folder / "file"), "");
  EXPECT_THAT(refusal(folder / "folder"), HasSubstr("it is a folder"));
  EXPECT_THAT(refusal(folder / "file/below"), HasSubstr("is not a folder"));
  EXPECT_THAT(refusal(folder / "missing/below"), HasSubstr("does not exist"));
  EXPECT_THAT(refusal("/dev/null"), HasSubstr("not a regular file"));
  EXPECT_THAT(refusal(""), HasSubstr("empty"));
  EXPECT_THAT(refusal(folder / "missing/below"), HasSubstr((folder / "missing/below").string()));
}

TEST(CheckWritable, RefusesAReadOnlyFolder) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(refusal(folder / "a"), HasSubstr("cannot be written"));
  fs::permissions(folder.path(), fs::perms::owner_all);
}

}  // namespace
}  // namespace gatelight::neural
