#include "renderer/surface/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/image/srgb.h"

namespace gatelight::renderer {
namespace {

/// A scene whose only material reads the picture as base colour (sRGB) and as normal map (linear).
scene::Scene scene_with(scene::Image image, scene::Wrap wrap = scene::Wrap::repeat, bool nearest = false) {
  scene::Scene s;
  s.images.push_back(std::move(image));
  s.textures.push_back({0, wrap, wrap, nearest});
  scene::Material m;
  m.base_color_texture.texture = 0;
  m.normal_texture.texture = 0;
  s.materials.push_back(m);
  return s;
}

scene::Image grey_ramp(int width, int height) {
  scene::Image image{"ramp", width, height, 1, {}};
  for (int i = 0; i < width * height; ++i) image.pixels.push_back(static_cast<std::uint8_t>(i * 37 % 256));
  return image;
}

scene::TextureSlot slot() {
  scene::TextureSlot s;
  s.texture = 0;
  return s;
}

TEST(Texture, TexelCentresReadTheFilesValues) {
  const scene::Scene s = scene_with(grey_ramp(7, 5));
  const Textures textures(s);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      const Vec2 uv((static_cast<float>(x) + 0.5f) / 7.0f, (static_cast<float>(y) + 0.5f) / 5.0f);
      const std::uint8_t byte = s.images[0].pixels[static_cast<std::size_t>(y * 7 + x)];
      EXPECT_NEAR(textures.lookup(slot(), Encoding::linear, uv, 0.0f, 0.0f).x(), byte / 255.0f, 1e-5f);
      EXPECT_NEAR(textures.lookup(slot(), Encoding::srgb, uv, 0.0f, 0.0f).x(), srgb_to_linear(byte / 255.0f),
                  1e-5f);
    }
  }
}

TEST(Texture, BilinearIsTheMeanHalfwayBetweenTexels) {
  const scene::Scene s = scene_with({"two", 2, 1, 1, {0, 200}}, scene::Wrap::clamp_to_edge);
  const Textures textures(s);
  EXPECT_NEAR(textures.lookup(slot(), Encoding::linear, {0.5f, 0.5f}, 0.0f, 0.0f).x(), 100.0f / 255.0f,
              1e-5f);
  // Filtering happens in linear light: the mean of the decoded values, not the decoded mean.
  EXPECT_NEAR(textures.lookup(slot(), Encoding::srgb, {0.5f, 0.5f}, 0.0f, 0.0f).x(),
              0.5f * srgb_to_linear(200.0f / 255.0f), 1e-5f);
}

TEST(Texture, WrapModesContinueThePicture) {
  const scene::Image image{"four", 4, 1, 1, {10, 60, 120, 250}};
  const auto at = [&](scene::Wrap wrap, float texel) {
    const scene::Scene s = scene_with(image, wrap);
    return std::lround(
        Textures(s).lookup(slot(), Encoding::linear, {(texel + 0.5f) / 4.0f, 0.5f}, 0.0f, 0.0f).x() * 255);
  };
  EXPECT_EQ(at(scene::Wrap::repeat, 5), 60);
  EXPECT_EQ(at(scene::Wrap::repeat, -1), 250);
  EXPECT_EQ(at(scene::Wrap::clamp_to_edge, 9), 250);
  EXPECT_EQ(at(scene::Wrap::clamp_to_edge, -3), 10);
  EXPECT_EQ(at(scene::Wrap::mirrored_repeat, 4), 250);
  EXPECT_EQ(at(scene::Wrap::mirrored_repeat, -1), 10);
  EXPECT_EQ(at(scene::Wrap::mirrored_repeat, 9), 60);
}

TEST(Texture, NearestHasNoValuesBetweenTexels) {
  const scene::Scene s = scene_with({"two", 2, 1, 1, {0, 200}}, scene::Wrap::repeat, true);
  const Textures textures(s);
  for (float u = 0.0f; u < 2.0f; u += 0.013f) {
    const float v = textures.lookup(slot(), Encoding::linear, {u, 0.5f}, 0.0f, 0.0f).x() * 255.0f;
    EXPECT_TRUE(std::abs(v) < 1e-3f || std::abs(v - 200.0f) < 1e-3f) << u;
  }
}

TEST(Texture, EveryLevelKeepsTheMeanInLinearLight) {
  for (const auto& [w, h] : {std::pair{64, 64}, {37, 19}, {1, 33}, {3, 1}}) {
    const scene::Scene s = scene_with(grey_ramp(w, h));
    const Textures textures(s);
    double mean = 0.0;
    for (std::uint8_t byte : s.images[0].pixels)
      mean += static_cast<double>(srgb_to_linear(byte / 255.0f)) / (w * h);
    EXPECT_NEAR(textures.mean(slot(), Encoding::srgb).x(), mean, 1e-4);
    // A footprint as wide as the picture reads the coarsest level, which is one texel.
    EXPECT_NEAR(textures.lookup(slot(), Encoding::srgb, {0.3f, 0.7f}, 2.0f, 0.99f).x(), mean, 0.01);
  }
}

TEST(Texture, MeanOverLevelsIsContinuousInTheFootprint) {
  const scene::Scene s = scene_with(grey_ramp(64, 64));
  const Textures textures(s);
  const auto trilinear = [&](float footprint) {
    double sum = 0.0;
    for (int i = 0; i < 64; ++i) {
      sum += static_cast<double>(textures
                                     .lookup(slot(), Encoding::linear, {0.41f, 0.23f}, footprint,
                                             (static_cast<float>(i) + 0.5f) / 64)
                                     .x());
    }
    return sum / 64;
  };
  for (float f = 0.005f; f < 1.0f; f *= 1.05f) EXPECT_NEAR(trilinear(f), trilinear(f * 1.01f), 0.05) << f;
}

TEST(Texture, TransformMovesTheLookupAndScalesTheFootprint) {
  const scene::Scene s = scene_with(grey_ramp(16, 16));
  const Textures textures(s);
  scene::TextureSlot moved = slot();
  moved.transform << 2.0f, 0.0f, 0.25f, 0.0f, 2.0f, 0.5f;
  const Vec4 a = textures.lookup(moved, Encoding::linear, {0.1f, 0.2f}, 0.1f, 0.3f);
  const Vec4 b = textures.lookup(slot(), Encoding::linear, {0.45f, 0.9f}, 0.2f, 0.3f);
  EXPECT_TRUE(a.isApprox(b, 1e-5f));
}

TEST(Texture, NonFiniteAndHugeCoordinatesAreSafe) {
  const scene::Scene s = scene_with(grey_ramp(8, 8), scene::Wrap::mirrored_repeat);
  const Textures textures(s);
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 3e38f, -1e9f}) {
    const Vec4 v = textures.lookup(slot(), Encoding::srgb, {bad, bad}, 0.1f, 0.5f);
    EXPECT_TRUE(v.allFinite());
    EXPECT_TRUE((textures.lookup(slot(), Encoding::srgb, {0.5f, 0.5f}, bad, 0.5f)).allFinite());
  }
}

TEST(Texture, GreyAndAlphaChannelsExpand) {
  const scene::Scene s = scene_with({"ga", 1, 1, 2, {100, 50}});
  const Vec4 v = Textures(s).lookup(slot(), Encoding::linear, {0.5f, 0.5f}, 0.0f, 0.0f) * 255.0f;
  EXPECT_TRUE(v.isApprox(Vec4(100, 100, 100, 50), 1e-4f));
}

/// The same picture as grey_ramp(), with 16 bits.
scene::Image wide(const scene::Image& image) {
  scene::Image result{image.name, image.width, image.height, image.channels, {}};
  for (const std::uint8_t byte : image.pixels)
    result.pixels_16.push_back(static_cast<std::uint16_t>(byte * 257));
  return result;
}

TEST(Texture, SixteenBitsReadTheFilesValues) {
  scene::Image image{"wide", 7, 5, 3, {}};
  for (int i = 0; i < 7 * 5 * 3; ++i)
    image.pixels_16.push_back(static_cast<std::uint16_t>(i * 40503 % 65536));
  const scene::Scene s = scene_with(image);
  const Textures textures(s);
  for (int i = 0; i < 35; ++i) {
    const Vec2 uv((static_cast<float>(i % 7) + 0.5f) / 7.0f, (static_cast<float>(i / 7) + 0.5f) / 5.0f);
    const std::uint16_t* const p = &image.pixels_16[static_cast<std::size_t>(3 * i)];
    const Vec4 expected = Vec4(p[0], p[1], p[2], 65535) / 65535.0f;
    EXPECT_LT((textures.lookup(slot(), Encoding::linear, uv, 0.0f, 0.0f) - expected).norm(), 2e-6f);
    const Vec4 color = textures.lookup(slot(), Encoding::srgb, uv, 0.0f, 0.0f);
    EXPECT_NEAR(color.x(), srgb_to_linear(expected.x()), 1e-5f);
    EXPECT_EQ(color.w(), 1.0f);
  }
}

TEST(Texture, SixteenBitsDifferFromEightOnlyInPrecision) {
  for (const auto& [w, h] : {std::pair{64, 64}, {37, 19}, {1, 1}}) {
    for (const bool nearest : {false, true}) {
      const scene::Scene s8 = scene_with(grey_ramp(w, h), scene::Wrap::mirrored_repeat, nearest);
      const scene::Scene s16 = scene_with(wide(grey_ramp(w, h)), scene::Wrap::mirrored_repeat, nearest);
      const Textures t8(s8), t16(s16);
      EXPECT_EQ(t16.bytes(), 2 * t8.bytes());
      EXPECT_LT((t16.mean(slot(), Encoding::linear) - t8.mean(slot(), Encoding::linear)).norm(), 1e-5f);
      for (int i = 0; i < 200; ++i) {
        const auto a = static_cast<float>(i);
        const Vec2 uv(std::fmod(0.37f * a, 3.0f) - 1.0f, std::fmod(0.61f * a, 3.0f) - 1.0f);
        const float footprint = 0.002f * a, u_level = std::fmod(0.71f * a, 1.0f);
        const Vec4 difference = t16.lookup(slot(), Encoding::linear, uv, footprint, u_level) -
                                t8.lookup(slot(), Encoding::linear, uv, footprint, u_level);
        EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.5f / 255.0f + 1e-4f);
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
