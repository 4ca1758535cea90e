// A room in which rays, lights and objects have all kinds of rules: the parts of its picture add up to it,
// and its bits depend neither on threads, regions and ranks nor on interruptions.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/render.h"
#include "tests/renderer/image/kinds_of_pictures.h"
#include "tests/support/restricted_room.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thread_ranks.h"

namespace gatelight::renderer {
namespace {

RenderOptions options_of_room() {
  RenderOptions options = testing::small_picture();
  options.environment.fog = FogOptions{.density = 0.05f, .albedo = Color(0.9f, 0.8f, 0.7f)};
  options.spp = 4;
  options.threads = 2;
  options.light_groups = {{"lamp", {"lamp"}},
                          {"panel", {"panel"}},
                          {"bulb", {"bulb"}},
                          {"noon", {"noon"}},
                          {"sky", {"environment"}}};
  options.aovs = all_passes();
  options.aovs.insert(options.aovs.end(), {Aov::raw, Aov::depth, Aov::albedo, Aov::instance_id});
  return options;
}

Picture restricted_picture(const RenderOptions& options) {
  const scene::Scene room = testing::restricted_room();
  return Renderer(room, options).render();
}

/// Expects the layers to add up to the picture, and each to have light.
void expect_sum_of_layers(const Picture& picture, const std::vector<std::string>& layers) {
  const std::vector<float>& whole = picture.find("raw")->values;
  std::vector<double> sums(whole.size(), 0.0);
  for (const std::string& name : layers) {
    const Layer* const layer = picture.find(name);
    ASSERT_NE(layer, nullptr) << name;
    double all = 0.0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
      sums[i] += static_cast<double>(layer->values[i]);
      all += static_cast<double>(layer->values[i]);
    }
    EXPECT_GT(all, 0.0) << name;
  }
  for (std::size_t i = 0; i < whole.size(); ++i)
    ASSERT_NEAR(sums[i], static_cast<double>(whole[i]), 1e-6 * (std::abs(sums[i]) + 1e-3)) << i;
}

TEST(RestrictedRoom, IsTheSumOfItsPasses) {
  std::vector<std::string> names;
  for (const Aov aov : all_passes()) names.emplace_back(info_of(aov).name);
  expect_sum_of_layers(restricted_picture(options_of_room()), names);
}

TEST(RestrictedRoom, IsTheSumOfItsLightGroups) {
  expect_sum_of_layers(restricted_picture(options_of_room()),
                       {"light-lamp", "light-panel", "light-bulb", "light-noon", "light-sky"});
}

void expect_same_layers(const Picture& a, const Picture& b) {
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i)
    EXPECT_TRUE(a.layers[i].values == b.layers[i].values) << a.layers[i].name;
}

TEST(RestrictedRoom, HasTheSameBitsForAnyNumberOfThreads) {
  RenderOptions options = options_of_room();
  const Picture two = restricted_picture(options);
  for (const int threads : {1, 7}) {
    options.threads = threads;
    expect_same_layers(restricted_picture(options), two);
  }
}

TEST(RestrictedRoom, HasTheBitsOfTheWholeInARegion) {
  RenderOptions options = options_of_room();
  const Picture whole = restricted_picture(options);
  options.region = {7, 3, 41, 37};
  const Picture part = restricted_picture(options);
  for (std::size_t l = 0; l < whole.layers.size(); ++l) {
    const std::size_t channels = whole.layers[l].channels.size();
    for (std::size_t y = 3; y < 37; ++y) {
      for (std::size_t x = 7 * channels; x < 41 * channels; ++x) {
        const std::size_t there = (y - 3) * 34 * channels + x - 7 * channels;
        ASSERT_EQ(part.layers[l].values[there], whole.layers[l].values[y * 50 * channels + x])
            << whole.layers[l].name;
      }
    }
  }
}

TEST(RestrictedRoom, HasTheSameBitsAfterAnInterruption) {
  const scene::Scene room = testing::restricted_room();
  RenderOptions options = options_of_room();
  const kinds::Result straight = kinds::result_of(room, options);
  const tests::TemporaryFolder folder;
  options.checkpoint = {.file = folder / "picture", .every_seconds = 0.0, .resume = true};
  EXPECT_TRUE(kinds::result_of(room, options, 3).statistics.interrupted);
  options.threads = 1;
  kinds::expect_same(kinds::result_of(room, options), straight);
}

TEST(RestrictedRoom, HasTheSameBitsByThreeRanks) {
  const scene::Scene room = testing::restricted_room();
  const RenderOptions options = options_of_room();
  Picture together;
  tests::run_ranks(3, [&](Ranks& ranks) {
    RenderOptions own = options;
    own.ranks = &ranks;
    Picture picture = Renderer(room, own).render();
    if (ranks.first()) together = std::move(picture);
  });
  expect_same_layers(together, restricted_picture(options));
}

TEST(RestrictedRoom, DiffersFromTheRoomWithoutAnyOfItsRules) {
  const scene::Scene room = testing::restricted_room();
  const RenderOptions options = options_of_room();
  const std::vector<float> with_all = Renderer(room, options).render().layers[0].values;
  const auto without = [&](const auto& change) {
    scene::Scene changed = room;
    change(changed);
    EXPECT_NE(Renderer(changed, options).render().layers[0].values, with_all);
  };
  for (std::size_t i = 0; i < room.instances.size(); ++i) {
    if (room.instances[i].visibility == scene::Visibility()) continue;
    SCOPED_TRACE(i);
    without([&](scene::Scene& s) { s.instances[i].visibility = {}; });
  }
  for (const std::size_t l : {0u, 1u}) without([&](scene::Scene& s) { s.lights[l].link = {}; });
  without([&](scene::Scene& s) { s.instances.back().link = {}; });
  without([&](scene::Scene& s) { s.environment_rays = scene::kAllRays; });
}

}  // namespace
}  // namespace gatelight::renderer
