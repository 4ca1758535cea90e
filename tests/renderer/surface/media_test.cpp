#include "renderer/surface/media.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

using scene::kNoVolume;

TEST(MediumStack, TheSmallestNumberIsTheStrongest) {
  MediumStack in;
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

TEST(MediumStack, ForgetsTheWeakestOfTooMany) {
  MediumStack in;
  constexpr std::uint32_t kAll = MediumStack::kMax + 3;
  for (std::uint32_t v = kAll; v-- > 0;) in.enter(v);
  for (std::uint32_t v = 0; v < MediumStack::kMax; ++v) {
    EXPECT_EQ(in.strongest(), v);
    in.leave(v);
  }
  EXPECT_EQ(in.strongest(), kNoVolume);
  for (std::uint32_t v = 0; v < kAll; ++v) in.enter(v);
  EXPECT_EQ(in.strongest_but(0), 1u);
  in.leave(kAll - 1);
  EXPECT_EQ(in.strongest(), 0u);
}

TEST(Vanish, GlassLetsAllLightPassAndOpaquePartsStay) {
  SurfaceMaterial label{
      .base_color = Color(0.2f, 0.5f, 0.9f), .metallic = 0.2f, .roughness = 0.4f, .transmission = 0.5f};
  label.thin_walled = false;
  label.clearcoat = 1.0f;
  EXPECT_FLOAT_EQ(glass_share(label), 0.4f);
  const Vec3 up(0, 0, 1), wo = Vec3(0.6f, 0, 0.8f);
  SurfaceMaterial glass = label, rest = label;
  EXPECT_TRUE(make_index_matched(glass, 0.39f));
  EXPECT_TRUE((Bsdf(glass, up, up, up, wo, true).unrefracted_transmittance() == 1.0f).all());
  EXPECT_FALSE(make_index_matched(rest, 0.41f));
  EXPECT_EQ(rest.transmission, 0.0f);
  // 0.2 of the remaining 0.6 was metal.
  EXPECT_FLOAT_EQ(rest.metallic, 1.0f / 3.0f);
}

}  // namespace
}  // namespace gatelight::renderer
