#include "renderer/surface/media.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

using scene::kNoVolume;

TEST(Interior, TheSmallestNumberIsTheStrongest) {
  Interior in;
  EXPECT_EQ(in.strongest(), kNoVolume);
  EXPECT_EQ(in.strongest_but(3), kNoVolume);
  for (const std::uint32_t v : {5u, 2u, 9u, 2u}) in.enter(v);
  EXPECT_EQ(in.strongest(), 2u);
  EXPECT_EQ(in.strongest_but(2), 5u);
  EXPECT_EQ(in.strongest_but(9), 2u);
  in.leave(2);
  EXPECT_EQ(in.strongest(), 5u);
  in.leave(7);
  in.leave(5);
  EXPECT_EQ(in.strongest(), 9u);
  EXPECT_EQ(in.strongest_but(9), kNoVolume);
  in.leave(9);
  in.leave(9);
  EXPECT_EQ(in.strongest(), kNoVolume);
}

TEST(Interior, ForgetsTheWeakestOfTooMany) {
  Interior in;
  constexpr std::uint32_t kAll = Interior::kMost + 3;
  for (std::uint32_t v = kAll; v-- > 0;) in.enter(v);
  for (std::uint32_t v = 0; v < Interior::kMost; ++v) {
    EXPECT_EQ(in.strongest(), v);
    in.leave(v);
  }
  EXPECT_EQ(in.strongest(), kNoVolume);
  for (std::uint32_t v = 0; v < kAll; ++v) in.enter(v);
  EXPECT_EQ(in.strongest_but(0), 1u);
  in.leave(kAll - 1);
  EXPECT_EQ(in.strongest(), 0u);
}

TEST(Vanish, GlassLetsAllLightPassAndWhatIsOpaqueStays) {
  SurfaceMaterial glass{
      .base_color = Color(0.2f, 0.5f, 0.9f), .roughness = 0.4f, .transmission = 1.0f, .thin_walled = false};
  glass.clearcoat = 1.0f;
  vanish(glass);
  const Vec3 up(0, 0, 1), wo = Vec3(0.6f, 0, 0.8f);
  EXPECT_TRUE((Bsdf(glass, up, up, up, wo, true).straight_transmittance() == 1.0f).all());

  SurfaceMaterial label{
      .base_color = Color(0.2f, 0.5f, 0.9f), .roughness = 0.4f, .transmission = 0.5f, .thin_walled = false};
  vanish(label);
  const Bsdf bsdf(label, up, up, up, wo, true);
  EXPECT_TRUE(bsdf.albedo().isApprox(label.base_color, 1e-3f)) << "half of it is paint, half clear";
  EXPECT_GT(bsdf.evaluate(up).value.minCoeff(), 0.0f);
}

}  // namespace
}  // namespace gatelight::renderer
