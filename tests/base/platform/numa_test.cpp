#include "base/platform/numa.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace gatelight {
namespace {

TEST(Numa, ListsOfTheKernelAreRead) {
  EXPECT_EQ(nodes_of_list("0"), 0b1u);
  EXPECT_EQ(nodes_of_list("0-1,4\n"), 0b10011u);
  EXPECT_EQ(nodes_of_list("2-3"), 0b1100u);
  EXPECT_EQ(nodes_of_list("60-200"), 0xfull << 60);
  EXPECT_EQ(nodes_of_list(""), 0u);
  EXPECT_EQ(nodes_of_list("none"), 0u);
}

TEST(Numa, OneNodeOrNoneIsLeftAlone) {
  const tests::TemporaryFolder root;
  EXPECT_EQ(interleave_memory(root.path()), 1);
  root.write("sys/devices/system/node/has_memory", "0\n");
  EXPECT_EQ(interleave_memory(root.path()), 1);
}

}  // namespace
}  // namespace gatelight
