// Frames whose lamps go off and on: a kept cache leaves nothing of its old light in them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

#include "renderer/render.h"
#include "tests/support/scene_builder.h"
#include "tests/support/thread_ranks.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;
using Lamps = std::array<float, 2>;  ///< their radiance

/// A closed room with two lamps under its ceiling.
struct LampRoom {
  LampRoom() {
    const int white = builder.material(SceneBuilder::lambert(Color::Constant(0.7f)));
    builder.box(white, Vec3(-1, -1, -3), Vec3(1, 1, 3), true);
    for (const float z : {-0.3f, -1.8f}) {
      const int lamp = builder.material(SceneBuilder::lambert(Color::Zero()));
      builder.quad(lamp, Vec3(-0.3f, 0.98f, z), Vec3(0.6f, 0, 0), Vec3(0, 0, 0.6f));
    }
    builder.scene().motion.materials = true;
    set({1.0f, 0.0f});
  }

  void set(const Lamps& lamps) {
    for (std::size_t i = 0; i < lamps.size(); ++i)
      builder.scene().materials[i + 1].emission.setConstant(lamps[i]);
  }

  static RenderOptions options(Integrator integrator) {
    RenderOptions options;
    options.integrator = integrator;
    options.width = 32;
    options.height = 24;
    options.spp = integrator == Integrator::nrc ? 2 : 256;
    options.camera.look_at = LookAt{Vec3(0, 0, 2.9f), Vec3(0, 0, 0), Vec3(0, 1, 0)};
    options.cache.source = TrainingSource::picture;
    options.cache.train_steps = 128;
    options.cache.batch = 1024;
    return options;
  }

  SceneBuilder builder;
};

std::vector<float> light_of(const Picture& picture) {
  return picture.layers.front().values;
}

double mean_light(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The frames with these lamps, of the first rank.
std::vector<std::vector<float>> frames_of(const std::vector<Lamps>& lamps, int ranks, int threads) {
  std::vector<std::vector<float>> frames;
  tests::run_ranks(ranks, [&](Ranks& mine) {
    LampRoom room;
    RenderOptions options = LampRoom::options(Integrator::nrc);
    options.threads = threads;
    options.ranks = &mine;
    Renderer renderer(room.builder.scene(), options);
    renderer.begin_frames(0.0);
    for (std::size_t i = 0; i < lamps.size(); ++i) {
      room.set(lamps[i]);
      renderer.scene_moved(options.camera);
      const Picture picture = renderer.render_frame(static_cast<int>(i), {});
      if (mine.first()) frames.push_back(light_of(picture));
    }
  });
  return frames;
}

double light_of_paths(const Lamps& lamps) {
  LampRoom room;
  room.set(lamps);
  return mean_light(light_of(Renderer(room.builder.scene(), LampRoom::options(Integrator::path)).render()));
}

TEST(FramesOfACache, AreBlackWhereTheLampIsOff) {
  const auto frames = frames_of({{1.0f, 0.0f}, {0.0f, 0.0f}, {0.0f, 0.0f}, {1.0f, 0.0f}}, 1, 2);
  for (const std::size_t dark : {1u, 2u}) {
    EXPECT_EQ(*std::max_element(frames[dark].begin(), frames[dark].end()), 0.0f);
    EXPECT_EQ(*std::min_element(frames[dark].begin(), frames[dark].end()), 0.0f);
  }
  const double lit = light_of_paths({1.0f, 0.0f});
  EXPECT_NEAR(mean_light(frames[0]) / lit, 1.0, 0.03);
  EXPECT_NEAR(mean_light(frames[3]) / lit, 1.0, 0.03) << "the lamp is on again";
  LampRoom dark;
  dark.set({0.0f, 0.0f});
  const auto alone = light_of(Renderer(dark.builder.scene(), LampRoom::options(Integrator::nrc)).render());
  EXPECT_EQ(*std::max_element(alone.begin(), alone.end()), 0.0f) << "a still";
}

TEST(FramesOfACache, HaveTheLightOfTheLampsThatAreOn) {
  constexpr Lamps kBoth = {1.0f, 0.03f}, kDim = {0.0f, 0.03f};
  const std::vector<Lamps> lamps = {kBoth, kBoth, kDim, kDim, kBoth};
  const auto frames = frames_of(lamps, 1, 2);
  const double both = light_of_paths(kBoth), dim = light_of_paths(kDim);
  for (std::size_t i = 0; i < lamps.size(); ++i)
    EXPECT_NEAR(mean_light(frames[i]) / (lamps[i] == kBoth ? both : dim), 1.0, 0.03) << "frame " << i;
}

TEST(FramesOfACache, FollowALampThatIsDimmed) {
  std::vector<Lamps> lamps;
  for (int i = 0; i < 12; ++i) lamps.push_back({1.0f - static_cast<float>(i) / 12.0f, 0.0f});
  const auto frames = frames_of(lamps, 1, 2);
  const double full = light_of_paths(lamps.front());
  for (std::size_t i = 0; i < lamps.size(); ++i)
    EXPECT_NEAR(mean_light(frames[i]) / full / static_cast<double>(lamps[i][0]), 1.0, 0.04) << "frame " << i;
}

TEST(FramesOfACache, AreTheSameForAnyRanksAndThreads) {
  const std::vector<Lamps> lamps = {{1.0f, 0.03f}, {1.0f, 0.03f}, {0.0f, 0.03f}, {0.9f, 0.03f}};
  const auto one = frames_of(lamps, 1, 1);
  EXPECT_TRUE(frames_of(lamps, 1, 2) == one);
  EXPECT_TRUE(frames_of(lamps, 3, 1) == one);
}

}  // namespace
}  // namespace gatelight::renderer
