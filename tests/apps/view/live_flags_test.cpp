#include "apps/view/live_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"

namespace gatelight::apps {
namespace {

using ::testing::ElementsAre;

TEST(LiveFlags, ReplaceThoseOfTheCommandLine) {
  const std::vector<std::string> words = {"--preset=final", "--exposure=2", "--camera=hall"};
  const LiveFlags flags = changed({}, {{"exposure", "-1"}, {"eye", "0,1,2"}, {"target", "0,0,0"}});
  const RenderSettings settings = settings_of("a room.glb", words, flags);
  EXPECT_EQ(settings.exposure, -1.0f);
  ASSERT_TRUE(settings.render.camera.look_at);
  EXPECT_EQ(settings.render.camera.look_at->eye, Vec3(0, 1, 2));
  EXPECT_EQ(settings.render.camera.name, "") << "--eye is instead of --camera";
  EXPECT_EQ(render_command("a room.glb", words, flags),
            "gatelight render 'a room.glb' --preset=final --exposure=-1 --eye=0,1,2 --target=0,0,0");
}

TEST(LiveFlags, OfNoValueAreThoseOfTheCommandLineAgain) {
  const LiveFlags flags = changed({{"exposure", "3"}, {"fov", "40"}}, {{"exposure", std::nullopt}});
  EXPECT_EQ(flags, (LiveFlags{{"fov", "40"}}));
}

TEST(LiveFlags, ThatExcludeEachOtherDoNotStay) {
  EXPECT_EQ(changed({{"eye", "1,2,3"}, {"target", "0,0,0"}}, {{"camera", "1"}}),
            (LiveFlags{{"camera", "1"}}));
  EXPECT_EQ(changed({{"environment", "none"}}, {{"sky", "sun=10,20"}}), (LiveFlags{{"sky", "sun=10,20"}}));
  EXPECT_EQ(changed({{"lens", "50"}}, {{"fov", "40"}}), (LiveFlags{{"fov", "40"}}));
}

TEST(LiveFlags, SayWhatRaysSeeAndWhomLightsConcern) {
  const RenderSettings settings =
      settings_of("a.glb", {"--visibility=a=camera:off"},
                  changed({}, {{"visibility", "b=shadow:off"}, {"light-links", "key=receivers:a"}}));
  ASSERT_EQ(settings.load.visibility.size(), 1u);
  EXPECT_EQ(settings.load.visibility[0].name, "b");
  EXPECT_EQ(settings.load.light_links.at(0).light, "key");
}

TEST(LiveFlags, RefuseWhatAWindowDoesNotChange) {
  for (const char* name : {"output", "cache-out", "oidn", "config", "threads", "checkpoint", "", "x\n"})
    EXPECT_THROW(changed({}, {{name, "x"}}), BadOption) << name;
}

TEST(LiveFlags, OfTheCommandLineAreWordsAgain) {
  RenderSettings settings = settings_of("a.glb", {"--spp=7", "--show-hidden", "--lights=lamp=2;sun=off"}, {});
  EXPECT_THAT(given_words(settings), ElementsAre("--spp=7", "--show-hidden", "--lights=lamp=2;sun=off"));
}

}  // namespace
}  // namespace gatelight::apps
