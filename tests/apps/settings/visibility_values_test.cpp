// The values of --visibility and --light-links.

#include "apps/settings/visibility_flags.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using namespace scene;
using tests::expect_refused_parts;

constexpr const char* kVisibility = "visibility";
constexpr const char* kLinks = "light-links";

using Rules = std::vector<VisibilityRule>;

TEST(VisibilityText, HasKindsGroupsOfThemAndHoldouts) {
  EXPECT_EQ(read_visibility(
                kVisibility,
                "wall*=camera:off,shadow:off;decoy=shadow:only;environment=camera:off;cutout=holdout:on"),
            (Rules{{.name = "wall*", .off = kCameraRays | kShadowRays},
                   {.name = "decoy", .only = kShadowRays},
                   {.name = "environment", .off = kCameraRays},
                   {.name = "cutout", .holdout = true}}));
  EXPECT_EQ(read_visibility(kVisibility, "a=b= c=reflections:off, volume : on"),
            (Rules{{.name = "a=b= c", .on = kVolumeRays, .off = kDiffuseRays | kGlossyRays}}));
  EXPECT_EQ(read_visibility(kVisibility, "a=bounces:only,camera:only,holdout:off"),
            (Rules{{.name = "a", .only = kBounceRays | kCameraRays, .holdout = false}}));
  EXPECT_EQ(read_visibility(kVisibility, "a=bounces:off,transmission:on,glossy:on,glossy:off"),
            (Rules{{.name = "a", .on = kTransmissionRays, .off = kDiffuseRays | kGlossyRays | kVolumeRays}}))
      << "the last word about a kind counts";
}

TEST(VisibilityText, IsReadBack) {
  for (const char* text :
       {"wall*=camera:off,shadow:off;decoy=shadow:only", "a=b=diffuse:only,glossy:only,camera:on",
        "x=transmission:on,volume:off,holdout:on;x=holdout:off"})
    EXPECT_EQ(text_of(read_visibility(kVisibility, text)), text);
}

TEST(VisibilityText, BadPartsAreNamed) {
  const auto refuse = [](const std::string& text, const ErrorParts& wanted) {
    expect_refused_parts<BadOption>([&] { read_visibility(kVisibility, text); }, wanted);
  };
  refuse("", {kVisibility, "", "", "NAME=RAYS:on|off|only"});
  refuse("wall", {kVisibility, "wall", "", "NAME=RAYS:on|off|only"});
  refuse("=camera:off", {kVisibility, "=camera:off", "", "NAME=RAYS"});
  refuse("wall=", {kVisibility, "wall=", "", "NAME=RAYS"});
  refuse("wall=camera:off;", {kVisibility, "", "", "NAME=RAYS"});
  refuse("wall=off", {kVisibility, "off", "", "RAYS:on|off|only"});
  refuse("wall=camera:off,", {kVisibility, "", "", "RAYS:on|off|only"});
  refuse("wall=shadows:off", {kVisibility, "shadows", "", "reflections|bounces|holdout", "shadow"});
  refuse("wall=camera:no", {kVisibility, "no", "", "on|off|only"});
  refuse("wall=holdout:only", {kVisibility, "only", "", "on|off"});
  refuse("environment=holdout:on", {kVisibility, "environment=holdout:on", "holdout", "object"});
}

using Links = std::vector<LightLinkRule>;

TEST(LightLinkText, HasReceiversAndBlockersAndTheirOpposites) {
  EXPECT_EQ(read_light_links(kLinks, "key=receivers:hero*+floor;sun=not-blockers:glass*"),
            (Links{{"key", false, false, {"hero*", "floor"}}, {"sun", true, true, {"glass*"}}}));
  EXPECT_EQ(read_light_links(kLinks, "a=b=not-receivers:c=d:e, blockers: f"),
            (Links{{"a=b", false, true, {"c=d:e"}}, {"a=b", true, false, {" f"}}}))
      << "names may contain '=', ':' and spaces";
}

TEST(LightLinkText, IsReadBack) {
  for (const char* text : {"key=receivers:hero*+floor,blockers:a;sun=not-blockers:glass*",
                           "a=not-receivers:x,receivers:x;b=blockers:y;a=blockers:z"})
    EXPECT_EQ(text_of(read_light_links(kLinks, text)), text);
}

TEST(LightLinkText, BadPartsAreNamed) {
  const auto refuse = [](const std::string& text, const ErrorParts& wanted) {
    expect_refused_parts<BadOption>([&] { read_light_links(kLinks, text); }, wanted);
  };
  const char* const form = "LIGHT=receivers:NODE+NODE";
  refuse("", {kLinks, "", "", form});
  refuse("key", {kLinks, "key", "", form});
  refuse("=receivers:a", {kLinks, "=receivers:a", "", form});
  refuse("key=hero", {kLinks, "key=hero", "", form});
  refuse("key=receivers:a,b", {kLinks, "key=receivers:a,b", "", form});
  refuse("key=reciever:a",
         {kLinks, "reciever", "", "receivers|not-receivers|blockers|not-blockers", "receivers"});
  refuse("key=receivers:a,blocker:b", {kLinks, "blocker", "", "not-blockers", "blockers"});
  refuse("key=receivers:", {kLinks, "receivers:", "lacks", "NODE+NODE"});
  refuse("key=receivers:a+", {kLinks, "receivers:a+", "lacks", "NODE+NODE"});
}

}  // namespace
}  // namespace gatelight::apps
