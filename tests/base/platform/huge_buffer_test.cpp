#include "base/platform/huge_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace gatelight {
namespace {

TEST(HugeBuffer, IsZeroAndAlignedAtAnySize) {
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{1000}, std::size_t{1} << 20, (std::size_t{3} << 20) + 7}) {
    const HugeBuffer<float> buffer(size);
    EXPECT_TRUE(std::all_of(buffer.begin(), buffer.end(), [](float x) { return x == 0.0f; }));
    const std::size_t alignment = buffer.bytes() >= (std::size_t{2} << 20) ? std::size_t{2} << 20 : 64;
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.data()) % alignment, 0u) << size;
  }
}

TEST(HugeBuffer, CopiesAndMovesItsContents) {
  HugeBuffer<int> first(10);
  first[9] = 7;
  HugeBuffer<int> copy = first;
  first[9] = 8;
  EXPECT_EQ(copy[9], 7);
  const int* const data = copy.data();
  HugeBuffer<int> moved = std::move(copy);
  EXPECT_EQ(moved.data(), data);
  EXPECT_TRUE(copy.empty());  // NOLINT(bugprone-use-after-move): it is empty then
  copy = moved;
  EXPECT_EQ(copy[9], 7);
  EXPECT_EQ(HugeBuffer<int>(HugeBuffer<int>()).data(), nullptr);
}

TEST(HugeBuffer, ReserveGrowsOnly) {
  HugeBuffer<int> buffer;
  reserve(buffer, 4);
  buffer[3] = 1;
  reserve(buffer, 2);
  EXPECT_EQ(buffer.size(), 4u);
  EXPECT_EQ(buffer[3], 1);
  reserve(buffer, 5);
  EXPECT_EQ(buffer[3], 0);
}

}  // namespace
}  // namespace gatelight
