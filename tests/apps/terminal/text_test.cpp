#include "apps/terminal/text.h"

#include <gtest/gtest.h>

namespace gatelight::apps {
namespace {

TEST(Text, BytesHaveThreeDigitsAndAUnit) {
  EXPECT_EQ(format_bytes(0), "0 B");
  EXPECT_EQ(format_bytes(1023), "1023 B");
  EXPECT_EQ(format_bytes(1536), "1.50 KiB");
  EXPECT_EQ(format_bytes(1048575), "1.00 MiB");
  EXPECT_EQ(format_bytes(std::size_t{812} << 20), "812 MiB");
  EXPECT_EQ(format_bytes(std::size_t{3} << 40), "3.00 TiB");
}

TEST(Text, CountsAreRoundedAndIntegersGrouped) {
  EXPECT_EQ(format_count(0), "0");
  EXPECT_EQ(format_count(950), "950");
  EXPECT_EQ(format_count(999.6), "1.00 k");
  EXPECT_EQ(format_count(1240273), "1.24 M");
  EXPECT_EQ(format_count(5.5e13), "55000 G");
  EXPECT_EQ(format_integer(0), "0");
  EXPECT_EQ(format_integer(999), "999");
  EXPECT_EQ(format_integer(1240273), "1 240 273");
}

TEST(Text, DurationsReadLikeAClock) {
  EXPECT_EQ(format_duration(0.4), "0:00");
  EXPECT_EQ(format_duration(59.6), "1:00");
  EXPECT_EQ(format_duration(3727), "1:02:07");
  EXPECT_EQ(format_duration(-1), "0:00");
}

TEST(Text, CommandsSurviveAShell) {
  EXPECT_EQ(quote_command({"gatelight", "render", "my scene.glb", "it's", "", "--eye", "-1,2,3"}),
            R"(gatelight render 'my scene.glb' 'it'\''s' '' --eye -1,2,3)");
}

TEST(WithFlags, NamesFlagsButNotOtherWordsInBackTicks) {
  EXPECT_EQ(with_flags("`max-depth` 3 and `b2`"), "--max-depth 3 and --b2");
  for (const char* other : {"", "`", "``", "`open", "`gatelight render`", "`A`"})
    EXPECT_EQ(with_flags(other), other);
}

}  // namespace
}  // namespace gatelight::apps
