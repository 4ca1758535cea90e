#include "base/platform/memory.h"

#include <gtest/gtest.h>

#include "base/platform/threads.h"
#include "tests/support/temporary_folder.h"

namespace gatelight {
namespace {

using tests::TemporaryFolder;

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

/// Writes the files of a machine of 1 GiB with a quarter as much swap, of which this process uses 256 pages.
void write_machine(const TemporaryFolder& root) {
  root.write("proc/meminfo",
             "MemTotal:        1048576 kB\nMemFree:          10 kB\nHugePages_Total:       0\nSwapTotal:     "
             "   262144 kB\n");
  root.write("proc/self/statm", "100000 256 10 1 0 1 0\n");
}

TEST(MemoryRoom, IsTheUnusedMemoryAndSwap) {
  const TemporaryFolder root;
  write_machine(root);
  const MemoryRoom room = memory_room(root.path());
  EXPECT_EQ(room.bytes, 1280 * kMebibyte - 256 * 4096);
  EXPECT_EQ(room.limit, "the machine");
}

TEST(MemoryRoom, IsNarrowedByTheTightestControlGroup) {
  const TemporaryFolder root;
  write_machine(root);
  root.write("proc/self/cgroup", "4:memory:/a/b\n3:cpu:/\n0::/c\n");
  root.write("sys/fs/cgroup/memory/a/b/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(memory_room(root.path()).limit, "the machine");
  root.write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "536870912\n");
  EXPECT_EQ(memory_room(root.path()).bytes, 511 * kMebibyte);
  root.write("sys/fs/cgroup/c/memory.max", "max\n");
  EXPECT_EQ(memory_room(root.path()).bytes, 511 * kMebibyte);
  root.write("sys/fs/cgroup/memory.max", "268435456\n");
  EXPECT_EQ(memory_room(root.path()).bytes, 255 * kMebibyte);
  EXPECT_EQ(memory_room(root.path()).limit, "the control group");
  // The process may already use more than the limit allows.
  root.write("sys/fs/cgroup/memory.max", "1000\n");
  EXPECT_EQ(memory_room(root.path()).bytes, 0u);
}

TEST(MemoryRoom, IsUnlimitedWithoutSystemFiles) {
  const TemporaryFolder nothing;
  EXPECT_EQ(memory_room(nothing.path()).bytes, MemoryRoom().bytes);
}

TEST(RequireThreads, AcceptsThreadsThatCanBeStarted) {
  EXPECT_NO_THROW(require_threads(1));
  EXPECT_NO_THROW(require_threads(64));
  EXPECT_NO_THROW(require_threads(2));
}

}  // namespace
}  // namespace gatelight
