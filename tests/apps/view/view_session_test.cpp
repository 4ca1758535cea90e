#include "apps/view/view_session.h"

#include <gtest/gtest.h>

#include "apps/settings/complete_settings.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

using std::chrono::milliseconds;

const std::string kBox = GATELIGHT_SOURCE_DIR "/data/cornell-box.glb";
const std::vector<std::string> kWords = {"--preset=preview", "--size=48x32", "--spp=3", "--threads=2"};
constexpr milliseconds kLong{60000};

/// The next picture of the viewer that fits.
template <class Fits>
std::shared_ptr<const ShownPicture> next(ViewSession& session, const std::string& viewer, const Fits& fits) {
  std::uint64_t version = 0;
  while (const auto shown = session.wait(viewer, version, kLong)) {
    if (fits(*shown)) return shown;
    version = shown->version;
  }
  return nullptr;
}
bool is_complete(const ShownPicture& shown) {
  return shown.complete;
}

std::vector<float> colors_of(const renderer::Picture& picture) {
  return picture.layers.front().values;
}

/// What `gatelight render` makes with these flags.
std::vector<float> rendered(const LiveFlags& flags) {
  const RenderSettings settings = settings_of(kBox, kWords, flags);
  const scene::Scene scene = scene::load_gltf(kBox, settings.load);
  return colors_of(renderer::Renderer(scene, settings.render).render());
}

TEST(ViewSession, EndsWithThePictureOfRender) {
  ViewSession session(kBox, kWords);
  const auto first = next(session, "a", is_complete);
  ASSERT_TRUE(first);
  EXPECT_EQ(colors_of(first->picture), rendered({}));
  const FlagChange change = {
      {"eye", "0.2,1,3"}, {"target", "0,1,0"}, {"environment", "0.1,0.2,0.3"}, {"seed", "5"}};
  const std::uint64_t revision = session.change("a", change, "");
  const auto second =
      next(session, "a", [&](const ShownPicture& s) { return s.complete && s.revision == revision; });
  ASSERT_TRUE(second);
  EXPECT_EQ(colors_of(second->picture), rendered(session.flags("a")));
  EXPECT_NE(colors_of(second->picture), colors_of(first->picture));
  EXPECT_TRUE(session.status("a").complete);
}

TEST(ViewSession, ShowsEachStageInTurn) {
  ViewSession session(kBox, kWords);
  std::vector<Stage> stages;
  std::uint64_t version = 0;
  while (stages.empty() || stages.back() != Stage::final) {
    const auto shown = session.wait("a", version, kLong);
    ASSERT_TRUE(shown);
    EXPECT_GT(shown->version, version);
    version = shown->version;
    if (stages.empty() || stages.back() != shown->stage) stages.push_back(shown->stage);
    EXPECT_LE(shown->picture.width, 48);
  }
  EXPECT_TRUE(std::is_sorted(stages.begin(), stages.end()));
  const auto whole = session.last_whole("a");
  ASSERT_TRUE(whole);
  for (const char* layer : {"albedo", "normal", "depth", "position", "instance"})
    EXPECT_NE(whole->picture.find(layer), nullptr) << layer;
}

TEST(ViewSession, DimsALight) {
  ViewSession session(kBox, kWords);
  ASSERT_FALSE(session.outline()->json["glowing"].empty());
  session.change("a", {{"lights", "*=off"}}, "");
  const auto dark = next(session, "a", [](const ShownPicture& s) { return s.complete; });
  ASSERT_TRUE(dark);
  EXPECT_EQ(colors_of(dark->picture), rendered({{"lights", "*=off"}}));
}

TEST(ViewSession, HasACameraForEachViewer) {
  ViewSession session(kBox, kWords);
  session.change("b", {{"fov", "10"}}, "");
  const auto a = next(session, "a", is_complete), b = next(session, "b", is_complete);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(colors_of(a->picture), rendered({}));
  EXPECT_EQ(colors_of(b->picture), rendered({{"fov", "10"}}));
}

TEST(ViewSession, GivesUpAPictureThatIsNotWantedAnyMore) {
  std::vector<std::string> endless = kWords;
  endless[2] = "--spp=1000000";
  ViewSession session(kBox, endless);
  ASSERT_TRUE(next(session, "a", [](const ShownPicture& s) { return s.stage == Stage::refined; }));
  const std::uint64_t revision = session.change("a", {{"spp", "2"}}, "");
  const auto shown =
      next(session, "a", [&](const ShownPicture& s) { return s.revision == revision && s.complete; });
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->statistics.spp, 2);
}

TEST(ViewSession, RefusesWrongFlagsAndGoesOn) {
  ViewSession session(kBox, kWords);
  EXPECT_THROW(session.change("a", {{"exposure", "bright"}}, ""), BadOption);
  EXPECT_THROW(session.change("a", {{"output", "/tmp/x.exr"}}, ""), BadOption);
  // Known only once the picture is begun.
  session.change("a", {{"lights", "no such lamp=2"}}, "");
  while (session.status("a").error.empty()) session.wait("a", 1u << 30, milliseconds(20));
  EXPECT_NE(session.status("a").error.find("no such lamp"), std::string::npos);
  session.change("a", {{"lights", std::nullopt}}, "");
  ASSERT_TRUE(next(session, "a", is_complete));
  EXPECT_EQ(session.status("a").error, "");
}

TEST(ViewSession, KeepsNoMoreViewersThanItCanServe) {
  ViewSession session(kBox, kWords);
  for (int i = 0; i < 300; ++i) session.change("viewer-" + std::to_string(i), {{"seed", "1"}}, "");
  ASSERT_TRUE(next(session, "viewer-299", is_complete));
}

TEST(ViewSession, EndsWhileAPictureIsMade) {
  std::vector<std::string> endless = kWords;
  endless[2] = "--spp=1000000";
  ViewSession session(kBox, endless);
  ASSERT_TRUE(session.wait("a", 0, kLong));
  session.stop();
  EXPECT_EQ(session.wait("a", 1u << 30, kLong), nullptr);
}

}  // namespace
}  // namespace gatelight::apps
