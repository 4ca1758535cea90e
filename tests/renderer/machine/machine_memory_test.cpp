#include "renderer/machine/memory.h"

#include <gtest/gtest.h>

#include "renderer/film/memory_estimate.h"
#include "renderer/machine/errors.h"
#include "renderer/machine/threads.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using tests::TemporaryFolder;

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

/// A machine of 1 GiB with a quarter as much swap, of which this process holds 256 pages.
void write_machine(const TemporaryFolder& root) {
  root.write("proc/meminfo",
             "MemTotal:        1048576 kB\nMemFree:          10 kB\nHugePages_Total:       0\nSwapTotal:     "
             "   262144 kB\n");
  root.write("proc/self/statm", "100000 256 10 1 0 1 0\n");
}

TEST(MemoryRoom, IsWhatIsLeftOfMemoryAndSwap) {
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
  // More may be taken already than the limit allows.
  root.write("sys/fs/cgroup/memory.max", "1000\n");
  EXPECT_EQ(memory_room(root.path()).bytes, 0u);
}

TEST(MemoryRoom, WhereNothingIsToldIsAllThereCanBe) {
  const TemporaryFolder nothing;
  EXPECT_EQ(memory_room(nothing.path()).bytes, MemoryRoom().bytes);
}

TEST(RequireMemory, NamesWhatIsNeededAndWhatIsLeft) {
  const auto refusal = [](std::size_t limit, std::size_t all, std::size_t more) {
    RenderOptions options;
    options.memory_limit_bytes = limit;
    return tests::refusal<OutOfMemory>([&] { require_memory("it", options, all, more); });
  };
  EXPECT_EQ(refusal(0, 8 * kMebibyte, 4 * kMebibyte), "");
  EXPECT_EQ(refusal(8 * kMebibyte, 8 * kMebibyte, 0), "");
  tests::expect_message(refusal(7 * kMebibyte, 8 * kMebibyte, 0), {"it", "8 MiB", "--memory-limit 7"});
  tests::expect_names(refusal(0, 0, std::size_t{1} << 60), {"it", "1099511627776 MiB"});
}

TEST(RequireThreads, IsContentWithWhatCanBeStarted) {
  EXPECT_NO_THROW(require_threads(1));
  EXPECT_NO_THROW(require_threads(64));
  EXPECT_NO_THROW(require_threads(2));
}

}  // namespace
}  // namespace gatelight::renderer
