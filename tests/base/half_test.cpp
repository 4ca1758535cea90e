#include "base/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gatelight {
namespace {

TEST(Half, EveryHalfComesBack) {
  for (std::uint32_t bits = 0; bits < 0x10000u; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = half_to_float(half);
    if (std::isnan(value)) {
      EXPECT_EQ(float_to_half(value), half | 0x200u) << "as F16C does: quiet, with the same payload";
    } else {
      EXPECT_EQ(float_to_half(value), half);
    }
  }
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
  // Between each half and its neighbour: the middle goes to the even one, its float neighbours to their side.
  for (std::uint32_t bits = 0; bits < 0x7bffu; ++bits) {
    const auto low = static_cast<std::uint16_t>(bits);
    const auto high = static_cast<std::uint16_t>(bits + 1);
    const float middle = 0.5f * (half_to_float(low) + half_to_float(high));
    EXPECT_EQ(float_to_half(middle), bits % 2 == 0 ? low : high);
    EXPECT_EQ(float_to_half(std::nextafter(middle, 0.0f)), low);
    EXPECT_EQ(float_to_half(std::nextafter(middle, 1e9f)), high);
    EXPECT_EQ(float_to_half(-middle), 0x8000u | (bits % 2 == 0 ? low : high));
  }
}

TEST(Half, OverflowsToInfinityFrom65520) {
  EXPECT_EQ(float_to_half(65519.996f), 0x7bffu);
  EXPECT_EQ(float_to_half(65520.0f), 0x7c00u);
  EXPECT_EQ(float_to_half(std::numeric_limits<float>::infinity()), 0x7c00u);
  EXPECT_EQ(float_to_half(-std::numeric_limits<float>::infinity()), 0xfc00u);
  EXPECT_EQ(float_to_half(1e-9f), 0u);
}

}  // namespace
}  // namespace gatelight
