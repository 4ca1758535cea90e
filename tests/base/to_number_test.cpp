#include "base/to_number.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace gatelight {
namespace {

TEST(ToNumber, TheWholeTextMustBeANumber) {
  EXPECT_EQ(to_number<int>("-12"), -12);
  EXPECT_EQ(to_number<double>("1.5e3"), 1500.0);
  for (const char* text : {"", " 1", "1 ", "1x", "+1", "0x10", "one", "1,5"}) {
    EXPECT_FALSE(to_number<double>(text).has_value()) << text;
    EXPECT_FALSE(to_number<int>(text).has_value()) << text;
  }
}

TEST(ToNumber, NumbersOutOfTheRangeOfTheTypeAreNone) {
  EXPECT_EQ(to_number<std::uint8_t>("255"), 255);
  EXPECT_FALSE(to_number<std::uint8_t>("256").has_value());
  EXPECT_FALSE(to_number<std::size_t>("-1").has_value());
  EXPECT_FALSE(to_number<float>("1e39").has_value());
}

TEST(ToNumber, InfinityAndNanAreNumbersOfFloats) {
  EXPECT_TRUE(std::isinf(to_number<float>("inf").value()));
  EXPECT_TRUE(std::isnan(to_number<double>("nan").value()));
  EXPECT_FALSE(to_number<int>("inf").has_value());
}

}  // namespace
}  // namespace gatelight
