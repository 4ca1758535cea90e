#include "apps/settings/frame_range.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/apps/settings/read_flags.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using ::testing::ElementsAre;
using tests::expect_refusal;

std::vector<int> numbers(const std::string& text) {
  return parse_frames("--frames", text).numbers();
}

TEST(FrameRange, ReadsFirstLastAndStep) {
  EXPECT_THAT(numbers("3"), ElementsAre(3));
  EXPECT_THAT(numbers("3:3"), ElementsAre(3));
  EXPECT_THAT(numbers("0:3"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(numbers("-2:5:3"), ElementsAre(-2, 1, 4));
  EXPECT_THAT(numbers("4:0:-2"), ElementsAre(4, 2, 0));
  EXPECT_EQ(numbers("0:9999").size(), 10'000u);
  for (const char* text : {"3", "-2:5:3", "4:0:-3"})
    EXPECT_EQ(parse_frames("--frames", text).final(), numbers(text).back()) << text;
  EXPECT_EQ(text_of(parse_frames("--frames", "-2:5:3")), "-2:5:3");
}

TEST(FrameRange, RefusesOthersByName) {
  for (const char* text : {"", "a", "1:", "1:2:", "1:2:3:4", "1.5:2", "1:2:0", "5:0", "0:5:-1", "0:1000000",
                           "99999999999", "0:3 "})
    expect_refusal<BadOption>([&] { parse_frames("--frames", text); }, {"--frames"});
}

TEST(FrameNames, HaveThePlaceOfTheNumber) {
  EXPECT_EQ(name_of_frame("a/f-%04d.exr", 7), "a/f-0007.exr");
  EXPECT_EQ(name_of_frame("f.%d.png", 12), "f.12.png");
  EXPECT_EQ(name_of_frame("f.%3d.png", 12), "f. 12.png");
  EXPECT_EQ(name_of_frame("f####.png", 12), "f0012.png");
  EXPECT_EQ(name_of_frame("{frame}-##.png", 5), "5-05.png");
  EXPECT_EQ(name_of_frame("f-%04d.exr", -7), "f--007.exr");
  EXPECT_EQ(name_of_frame("f-%04d.exr", 123456), "f-123456.exr");
  EXPECT_EQ(name_of_frame("####/picture.exr", 5), "####/picture.exr") << "folders keep their names";
  EXPECT_TRUE(has_frame_place("a#b##.exr"));
  EXPECT_FALSE(has_frame_place("a#b.exr"));
}

TEST(FrameFlags, ExcludeWhatHasNoMeaningWithThem) {
  const auto refused = [](std::initializer_list<const char*> flags) {
    return refused_flags({flags.begin(), flags.end()});
  };
  tests::expect_message(refused({"--fps", "25"}), {"--fps", "--frames"});
  tests::expect_message(refused({"--frames", "0:3", "--time", "1"}), {"--time", "--frames"});
  tests::expect_message(refused({"--frames", "0:3"}), {"--output", "%04d"});
  tests::expect_message(refused({"--frames", "0:3", "--camera", "all"}), {"--camera", "--frames"});
  tests::expect_message(refused({"--preview-video", "a.mp4"}), {"--preview-video", "--frames"});
  tests::expect_message(refused({"--frames", "4", "--preview-video", "a.avi"}),
                        {"--preview-video", "a.avi", ".mp4"});
  tests::expect_message(refused({"--frames", "4", "--preview-video", "a%d.mp4"}),
                        {"--preview-video", "a%d.mp4"});
  const auto groups = [&](std::initializer_list<const char*> flags) {
    std::vector<const char*> all = {"--turntable", "4", "--frame-groups", "3"};
    all.insert(all.end(), flags);
    return refused_flags({all.begin(), all.end()});
  };
  tests::expect_message(refused({"--frame-groups", "2"}), {"--frame-groups", "--frames"});
  tests::expect_message(refused({"--frames", "4", "--frame-groups", "2"}), {"--frame-groups", "2", "1"});
  tests::expect_message(groups({"--integrator", "nrc"}), {"--frame-groups", "nrc", "depend"});
  tests::expect_message(groups({"--denoiser", "auto"}), {"--frame-groups", "--temporal"});
  tests::expect_message(groups({"--aov", "motion"}), {"--frame-groups", "motion"});
  tests::expect_message(groups({"--checkpoint", "state"}), {"--frame-groups", "--checkpoint"});
  EXPECT_THAT(groups({"--denoiser", "auto", "--temporal", "off"}), ::testing::StartsWith("--output"));
  EXPECT_EQ(refused({"--frames", "4"}), "") << "one frame needs no pattern";
  EXPECT_EQ(read_flags({"--turntable", "1"}).load.time, 0.0);
  EXPECT_EQ(read_flags({"--frames", "12:12", "--fps", "24"}).load.time, 0.5);
}

}  // namespace
}  // namespace gatelight::apps
