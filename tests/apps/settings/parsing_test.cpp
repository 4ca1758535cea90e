#include "apps/settings/parsing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using renderer::Choice;
using renderer::Choices;
using renderer::name_of;
using ::testing::ElementsAre;
using tests::expect_parts;

ErrorParts refusal(const std::function<void()>& parse) {
  return tests::refused_parts<BadOption>(parse);
}

TEST(Values, IntegersAreWholeWordsInTheirRange) {
  EXPECT_EQ(parse_integer("n", "17", {1, 20}), 17);
  EXPECT_EQ(parse_integer("n", "-3", {-3, 20}), -3);
  for (const char* text :
       {"", "0", "21", "1.5", "2x", " 2", "2 ", "0x10", "1e1", "99999999999999999999", "-"}) {
    expect_parts(refusal([&] { parse_integer("n", text, {1, 20}); }), {"n", text, "", "from 1 to 20"});
  }
}

TEST(Values, RealsRespectOpenAndClosedEnds) {
  const RealRange open{.min = 0.0, .max = 180.0, .excludes_min = true, .excludes_max = true};
  EXPECT_DOUBLE_EQ(parse_real("x", "1e-3", open), 1e-3);
  for (const char* text : {"0", "180", "-1", "nan", "inf", "-inf", "1,5", "", "x", "1e999"}) {
    EXPECT_EQ(refusal([&] { parse_real("x", text, open); }).option, "x") << text;
  }
  const RealRange closed{-1.0, 1.0};
  EXPECT_EQ(parse_real("x", "-1", closed), -1.0);
  EXPECT_EQ(parse_real("x", "1", closed), 1.0);
  expect_parts(refusal([&] { parse_real("x", "1.001", closed); }),
               {"x", "1.001", "", "of at least -1 and at most 1"});
}

TEST(Values, InfinityIsOnlyWhereItIsAllowed) {
  const RealRange distance{.min = 0.0, .max = kAnyFloat.max, .excludes_min = true, .infinity = true};
  EXPECT_TRUE(std::isinf(parse_real("d", "inf", distance)));
  EXPECT_EQ(refusal([&] { parse_real("d", "-inf", distance); }).option, "d");
  EXPECT_EQ(refusal([&] { parse_real("d", "nan", distance); }).option, "d");
  EXPECT_EQ(refusal([&] { parse_real("d", "inf", kAnyFloat); }).option, "d");
  // Finite, but not as a float.
  EXPECT_EQ(refusal([&] { parse_real("d", "1e39", kAnyFloat); }).option, "d");
}

TEST(Values, TriplesHaveThreeFiniteNumbers) {
  EXPECT_THAT(parse_triple("eye", "-.5,1e3,0", kAnyFloat), ElementsAre(-0.5f, 1000.0f, 0.0f));
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,2,", "1,2,x", "1,nan,2", "1 2 3"}) {
    expect_parts(refusal([&] { parse_triple("eye", text, kAnyFloat); }), {"eye", text});
  }
  EXPECT_TRUE(looks_like_triple("1,2,3"));
  EXPECT_FALSE(looks_like_triple("a,b,c.exr"));
  EXPECT_FALSE(looks_like_triple("1,2"));
}

TEST(Values, SizesAndRegionsAreInPixels) {
  EXPECT_THAT(parse_size("size", "65536x1"), ElementsAre(65536, 1));
  for (const char* text : {"", "0x5", "5x0", "65537x1", "10", "10x", "x10", "1x2x3", "-1x5", "10X10"}) {
    expect_parts(refusal([&] { parse_size("size", text); }), {"size", text, "", "from 1 to 65536"});
  }
  EXPECT_THAT(parse_region("region", "0,1,2,3"), ElementsAre(0, 1, 2, 3));
  for (const char* text : {"", "0,0,1", "0,0,0,1", "0,2,1,2", "-1,0,1,1", "0,0,1,1,1", "a,b,c,d"}) {
    expect_parts(refusal([&] { parse_region("region", text); }), {"region", text});
  }
}

TEST(Values, ChoicesNameAllOfThem) {
  constexpr Choice<int> kNumbers[] = {{"one", 1}, {"two", 2}};
  const Choices<int> choices = kNumbers;
  EXPECT_EQ(parse_choice("c", "two", choices), 2);
  EXPECT_EQ(name_of(choices, 1), "one");
  expect_parts(refusal([&] { parse_choice("c", "three", choices); }), {"c", "three", "", "one|two"});
}

TEST(Values, ListsHaveNoEmptyWords) {
  EXPECT_THAT(split_list("aov", "a,b"), ElementsAre("a", "b"));
  for (const char* text : {"", ",", "a,", ",a", "a,,b"}) {
    EXPECT_EQ(refusal([&] { split_list("aov", text); }).option, "aov") << text;
  }
}

TEST(Values, FloatsAreInTheRangeAsFloatsToo) {
  const RealRange below{.min = 0.0, .max = 180.0, .excludes_min = true, .excludes_max = true};
  EXPECT_EQ(parse_float("x", "0.1", below), 0.1f);
  expect_parts(refusal([&] { parse_float("x", "179.99999999999", below); }),
               {"x", "179.99999999999", "", "180"});
  expect_parts(refusal([&] { parse_float("x", "1e-46", below); }), {"x", "1e-46", "", "0"});
  const RealRange any{0.0, 3.4e38};
  EXPECT_EQ(parse_float("x", "0", any), 0.0f);
  expect_parts(refusal([&] { parse_float("x", "1e-41", any); }), {"x", "1e-41", "", "1.18e-38"});
}

}  // namespace
}  // namespace gatelight::apps
