// Light of an earlier frame in a frame of a file.

#include "renderer/reuse/picture_history.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gatelight::renderer {
namespace {

constexpr int kColumns = 48, kRows = 40;
constexpr std::size_t kCells = std::size_t{kColumns} * kRows;

std::vector<float> plane(std::initializer_list<float> pixel) {
  std::vector<float> plane;
  for (std::size_t i = 0; i < kCells; ++i) plane.insert(plane.end(), pixel);
  return plane;
}

/// A wall of one colour: samples that are too bright and too dark in turn.
FrameLayers wall(float light, float noise = 0.0f) {
  FrameLayers frame{.rect = {0, 0, kColumns, kRows},
                    .albedo = plane({0.5f, 0.5f, 0.5f}),
                    .normal = plane({0, 0, 1}),
                    .depth = plane({4}),
                    .object = plane({1}),
                    .motion = plane({0, 0})};
  for (std::size_t i = 0; i < kCells; ++i) {
    const bool brighter = (i % kColumns + i / kColumns) % 2 == 0;
    frame.color.insert(frame.color.end(), 3, light * (brighter ? 1.0f + noise : 1.0f - noise));
  }
  return frame;
}

PictureHistory history(float light, float frames, const FrameLayers& layers = wall(1.0f)) {
  return {layers, std::vector<float>(3 * kCells, light), std::vector<float>(kCells, frames)};
}

CarriedLight carried(const FrameLayers& frame, const PictureHistory& history, float denoised = 1.0f) {
  return carry_picture(frame, std::vector<float>(3 * kCells, denoised), &history);
}

TEST(PictureHistory, IsTakenByTheNumberOfItsFrames) {
  const CarriedLight light = carried(wall(1.0f, 0.3f), history(1.0f, 3.0f));
  EXPECT_EQ(light.share, 1.0);
  for (std::size_t i = 0; i < kCells; ++i) {
    EXPECT_NEAR(light.weight[i], 0.75f, 1e-5f);
    EXPECT_NEAR(light.samples[i], 4.0f, 1e-5f);
  }
  EXPECT_NEAR(carried(wall(1.0f, 0.3f), history(1.0f, 99.0f)).samples[0], 1.0f + kMostEarlier, 1e-4f);
  EXPECT_TRUE(carry_picture(wall(1.0f), std::vector<float>(3 * kCells, 1.0f), nullptr).color.empty());
}

TEST(PictureHistory, ComesFromWhereTheSurfaceWas) {
  FrameLayers now = wall(1.0f, 0.5f);
  now.motion = plane({3.0f, 2.0f});  // to the right and up
  PictureHistory before = history(1.0f, 3.0f);
  const auto light_at = [](std::size_t x, std::size_t y) {
    return 1.0f + 1e-5f * static_cast<float>(x) + 3e-6f * static_cast<float>(y);
  };
  for (std::size_t i = 0; i < kCells; ++i)
    std::fill_n(&before.color[3 * i], 3, light_at(i % kColumns, i / kColumns));
  const CarriedLight light = carry_picture(now, before.color, &before);
  for (std::size_t y = 0; y < kRows; ++y) {
    for (std::size_t x = 0; x < kColumns; ++x) {
      const std::size_t i = y * kColumns + x;
      ASSERT_EQ(light.weight[i] > 0.0f, x >= 3 && y + 2 < kRows) << x << ' ' << y;
      if (!(light.weight[i] > 0.0f)) continue;
      ASSERT_NEAR(light.color[3 * i], light_at(x - 3, y + 2), 1e-6f) << x << ' ' << y;
    }
  }
  now.rect = {100, 50, 100 + kColumns, 50 + kRows};  // a data window that has moved
  before.layers.rect = {97, 52, 97 + kColumns, 52 + kRows};
  EXPECT_EQ(carried(now, before).share, 1.0);
}

TEST(PictureHistory, IsOfTheSameSurface) {
  const auto share = [](const auto& change) {
    FrameLayers before = wall(1.0f);
    change(before);
    return carried(wall(1.0f, 0.3f), history(1.0f, 3.0f, before)).share;
  };
  EXPECT_EQ(share([](FrameLayers&) {}), 1.0);
  EXPECT_EQ(share([](FrameLayers& f) { f.object = plane({2}); }), 0.0);
  EXPECT_EQ(share([](FrameLayers& f) { f.normal = plane({1, 0, 0}); }), 0.0);
  EXPECT_EQ(share([](FrameLayers& f) { f.normal = plane({0, 0.2f, 2}); }), 1.0) << "of any length";
  EXPECT_EQ(share([](FrameLayers& f) { f.albedo = plane({0.8f, 0.5f, 0.5f}); }), 0.0);
  EXPECT_EQ(share([](FrameLayers& f) { f.depth = plane({5}); }), 0.0);
  EXPECT_EQ(share([](FrameLayers& f) { f.depth = plane({4.2f}); }), 1.0);
  EXPECT_EQ(share([](FrameLayers& f) { f.depth = plane({1e10f}); }), 0.0) << "the background";
  EXPECT_EQ(share([](FrameLayers& f) { f.albedo = f.normal = f.depth = f.object = {}; }), 1.0)
      << "it is unknown";
  FrameLayers still = wall(1.0f);
  still.motion = {};
  EXPECT_EQ(carried(still, history(1.0f, 3.0f)).share, 0.0) << "nothing tells where it was";
}

TEST(PictureHistory, IsOfTheSameLight) {
  // Noise of 30 % in 81 pixels is 3.3 %, and 1 % is allowed on top of two of these.
  EXPECT_EQ(carried(wall(1.0f, 0.3f), history(1.05f, 3.0f)).share, 1.0);
  EXPECT_EQ(carried(wall(1.0f, 0.3f), history(1.6f, 3.0f)).share, 0.0);
  EXPECT_EQ(carried(wall(1.0f, 0.3f), history(0.5f, 3.0f)).share, 0.0);
}

TEST(PictureHistory, EndsAtEdges) {
  const auto edges = [](const auto& change) {
    FrameLayers now = wall(1.0f, 0.3f);
    for (std::size_t i = 0; i < kCells; ++i) change(now, i, static_cast<float>(i % kColumns));
    const CarriedLight light = carried(now, history(1.0f, 3.0f, now));
    return std::count(light.samples.begin(), light.samples.begin() + kColumns, 0.0f);
  };
  // Two pixels on each side of a step, and two more around.
  EXPECT_EQ(edges([](FrameLayers& f, std::size_t i, float x) { f.object[i] = x < 20 ? 1.0f : 2.0f; }), 6);
  EXPECT_EQ(edges([](FrameLayers& f, std::size_t i, float x) { f.normal[3 * i] = x < 20 ? 0.0f : 1.0f; }), 6);
  EXPECT_EQ(edges([](FrameLayers& f, std::size_t i, float x) { f.depth[i] = x < 20 ? 4.0f : 6.0f; }), 6);
  EXPECT_EQ(edges([](FrameLayers& f, std::size_t i, float x) { f.depth[i] = 1.0f / (0.1f + 0.02f * x); }), 0)
      << "the inverse of depth is linear on a plane";
}

}  // namespace
}  // namespace gatelight::renderer
