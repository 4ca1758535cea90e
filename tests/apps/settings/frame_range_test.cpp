#include "apps/settings/frame_range.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using ::testing::ElementsAre;
using tests::expect_refused_parts;
using tests::refused_parts;

std::vector<int> numbers(const std::string& text) {
  return parse_frames("frames", text).numbers();
}

TEST(FrameRange, ReadsFirstLastAndStep) {
  EXPECT_THAT(numbers("3"), ElementsAre(3));
  EXPECT_THAT(numbers("3:3"), ElementsAre(3));
  EXPECT_THAT(numbers("0:3"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(numbers("-2:5:3"), ElementsAre(-2, 1, 4));
  EXPECT_THAT(numbers("4:0:-2"), ElementsAre(4, 2, 0));
  EXPECT_EQ(numbers("0:9999").size(), 10'000u);
}

TEST(FrameList, ReadsFramesAsPeopleWriteThem) {
  EXPECT_THAT(numbers("1,3,5-9"), ElementsAre(1, 3, 5, 6, 7, 8, 9));
  EXPECT_THAT(numbers("9-5:-2,1:7:3,-4"), ElementsAre(9, 7, 5, 1, 4, -4)) << "7 is there already";
  EXPECT_THAT(numbers("1-10x4"), ElementsAre(1, 5, 9));
  EXPECT_THAT(numbers("-3--1,0-0"), ElementsAre(-3, -2, -1, 0));
  EXPECT_THAT(numbers("2,1,2,1:3"), ElementsAre(2, 1, 3)) << "each once, at its first place";
  for (const char* text : {"-2:5:3", "7", "1,3,5-9", "-3--1,9:4:-2"})
    EXPECT_EQ(numbers(text_of(parse_frames("frames", text))), numbers(text)) << text;
  EXPECT_EQ(text_of(parse_frames("frames", "-2:5:3,7")), "-2:5:3,7:7");
  EXPECT_TRUE(parse_frames("frames", "4,4:4,4:9:7").is_single());
  EXPECT_FALSE(parse_frames("frames", "4,5").is_single());
  EXPECT_EQ(common_step(numbers("9:1:-4")), -4);
  EXPECT_EQ(common_step(numbers("1,3,5")), 2);
  EXPECT_EQ(common_step(numbers("1,3,6")), 1);
}

TEST(FrameList, HasFramesPerSecondAsAFraction) {
  EXPECT_EQ(parse_fps("fps", "25"), 25.0);
  EXPECT_EQ(parse_fps("fps", "30000/1001"), 30000.0 / 1001.0);
  for (const char* text : {"", "/", "30/", "/1001", "30/0", "0/0", "30000/1001/2", "-30/1", "30/-1", "0",
                           "1e9", "inf", "inf/1", "1/inf", "nan/1"})
    expect_refused_parts<BadOption>([&] { parse_fps("fps", text); }, {"fps", text});
}

TEST(FrameRange, RefusesOthersByName) {
  for (const char* text : {"",        "a",         "1:",          "1:2:",
                           "1:2:3:4", "1.5:2",     "1:2:0",       "5:0",
                           "0:5:-1",  "0:1000000", "99999999999", "0:3 ",
                           "1,",      ",1",        "1,,3",        "1;3",
                           "5-",      "1-3-5",     "1,9-5",       "0:600000,0:600000"})
    EXPECT_EQ(refused_parts<BadOption>([&] { parse_frames("frames", text); }).option, "frames") << text;
}

TEST(FrameNames, HaveThePlaceOfTheNumber) {
  EXPECT_EQ(name_of_frame("a/f-%04d.exr", 7), "a/f-0007.exr");
  EXPECT_EQ(name_of_frame("f.%d.png", 12), "f.12.png");
  EXPECT_EQ(name_of_frame("f.%3d.png", 12), "f. 12.png");
  EXPECT_EQ(name_of_frame("f####.png", 12), "f0012.png");
  EXPECT_EQ(name_of_frame("{frame}-##.png", 5), "5-05.png");
  EXPECT_EQ(name_of_frame("f-%04d.exr", -7), "f--007.exr");
  EXPECT_EQ(name_of_frame("f-%04d.exr", 123456), "f-123456.exr");
  EXPECT_EQ(name_of_frame("shot_%03d/####/beauty.exr", 5), "shot_005/0005/beauty.exr");
  EXPECT_EQ(name_of_frame("100%%-%%d-%d%%.png", 5), "100%-%d-5%.png");
  EXPECT_TRUE(has_frame_place("a#b##.exr"));
  EXPECT_TRUE(has_frame_place("shot_%d/a.exr"));
  for (const char* name : {"a#b.exr", "100%%d.exr", "%%04d.exr", "50%.exr"})
    EXPECT_FALSE(has_frame_place(name)) << name;
  EXPECT_EQ(name_in_given_folder("a/b%%/f-%d.exr", 7), "a/b%/f-7.exr");
  EXPECT_EQ(name_in_given_folder("a/shot_%d/take_2/f.exr", 7), "a/f.exr");
  EXPECT_EQ(name_in_given_folder("%d/f.exr", 7), "f.exr");
}

}  // namespace
}  // namespace gatelight::apps
