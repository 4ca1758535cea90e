// Panes of clear glass: the effect of their textures and vertex colours on the light of a shadow ray. Media.

#include <gtest/gtest.h>

#include "renderer/bsdf/bsdf.h"
#include "renderer/surface/coverage.h"
#include "renderer/surface/media.h"
#include "renderer/surface/surface.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::SceneBuilder;
using scene::kNoVolume;

/// Transmittance of a ray down through the middle of a pane's first triangle.
Color through(const scene::Scene& scene) {
  const Textures textures(scene);
  const Media media;
  const Coverage coverage(scene, textures, media);
  const Hit hit{.u = 0.25f, .v = 0.25f, .instance = 0};
  EXPECT_TRUE(coverage.filters_shadows(0));
  return coverage.pass(hit, Vec3(0, 0, -1)).transmittance;
}

scene::Scene pane_of(const scene::Material& material, const scene::Image* image = nullptr) {
  SceneBuilder builder;
  scene::Mesh& mesh = builder.quad(builder.material(material), Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  mesh.uv0.assign(4, Vec2(0.5f, 0.5f));
  scene::Scene scene = builder.scene();
  if (image) {
    scene.images.push_back(*image);
    scene.textures.push_back({.image = 0});
  }
  return scene;
}

/// An image of one texel.
scene::Image texel(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  return {.name = "texel", .width = 1, .height = 1, .channels = 4, .pixels = {red, green, blue, 255}};
}

/// Shadow rays end at these: their light arrives by other directions too.
TEST(Panes, OfVarnishedRoughOrThickGlassPassNothing) {
  const auto passed = [](auto change) {
    scene::Material material = SceneBuilder::clear_glass();
    material.alpha_mode = scene::AlphaMode::blend;
    change(material);
    return through(pane_of(material)).maxCoeff();
  };
  EXPECT_GT(passed([](scene::Material&) {}), 0.9f);
  EXPECT_EQ(passed([](scene::Material& m) { m.clearcoat = 0.5f; }), 0.0f);
  EXPECT_EQ(passed([](scene::Material& m) { m.sheen_color = Color(0.5f, 0.0f, 0.0f); }), 0.0f);
  EXPECT_EQ(passed([](scene::Material& m) { m.roughness = 0.1f; }), 0.0f);
  EXPECT_EQ(passed([](scene::Material& m) { m.thickness = 1.0f; }), 0.0f);
  EXPECT_EQ(passed([](scene::Material& m) { m.transmission = 0.0f; }), 0.0f);
}

TEST(Panes, ATextureTintsAsTheFactorDoes) {
  scene::Material textured = SceneBuilder::clear_glass();
  textured.base_color_texture.texture = 0;
  const scene::Image image = texel(255, 188, 0);  // sRGB 188 is half the light
  const Color seen = through(pane_of(textured, &image));
  const Color clear = through(pane_of(SceneBuilder::clear_glass()));
  EXPECT_GT(clear.minCoeff(), 0.9f);
  EXPECT_FLOAT_EQ(seen.x(), clear.x());
  scene::Material tinted = SceneBuilder::clear_glass();
  tinted.base_color = Color(1.0f, 0.50289f, 0.0f);
  EXPECT_TRUE(seen.isApprox(through(pane_of(tinted)), 1e-3f)) << seen.transpose();
}

TEST(Panes, VertexColoursTintAsTheFactorDoes) {
  scene::Scene coloured = pane_of(SceneBuilder::clear_glass());
  coloured.meshes[0].colors.assign(4, Vec4(0.25f, 0.5f, 1.0f, 1.0f));
  scene::Material tinted = SceneBuilder::clear_glass();
  tinted.base_color = Color(0.25f, 0.5f, 1.0f);
  EXPECT_TRUE(through(coloured).isApprox(through(pane_of(tinted)), 1e-5f));
}

TEST(Panes, TexturesOfTransmissionAndMetalDarkenAsTheirFactorsDo) {
  // Transmission is read from red, metal from blue.
  const scene::Image image = texel(64, 255, 128);
  scene::Material textured = SceneBuilder::clear_glass();
  textured.transmission_texture.texture = 0;
  scene::Material factors = SceneBuilder::clear_glass();
  factors.transmission = 64.0f / 255.0f;
  EXPECT_TRUE(through(pane_of(textured, &image)).isApprox(through(pane_of(factors)), 1e-4f));

  textured = SceneBuilder::clear_glass();
  textured.metallic = 1.0f;
  textured.metallic_roughness_texture.texture = 0;
  factors = SceneBuilder::clear_glass();
  factors.metallic = 128.0f / 255.0f;
  const Color metal = through(pane_of(textured, &image));
  EXPECT_TRUE(metal.isApprox(through(pane_of(factors)), 1e-4f));
  EXPECT_LT(metal.maxCoeff(), 0.6f);
}

TEST(Panes, HaveTheSameTransmittanceForLightSamplesAndForPaths) {
  scene::Material pane = SceneBuilder::clear_glass();
  pane.base_color = Color(0.9f, 0.8f, 0.7f);
  pane.ior = 2.0f;
  pane.specular = 0.8f;
  pane.specular_color = Color(0.9f, 0.6f, 0.3f);
  pane.metallic = 0.2f;
  pane.transmission = 0.7f;
  const scene::Scene scene = pane_of(pane);
  const Textures textures(scene);
  const Media media;
  const Hit hit{.u = 0.25f, .v = 0.25f, .instance = 0};
  for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(0.6f, 0, -0.8f), Vec3(0.6f, 0, 0.8f)}) {
    const Surface s = Surfaces(scene, textures).at(hit, direction, 0.0f, 0.0f);
    const Bsdf bsdf(s.material, s.geometric_normal, s.shading_normal, s.coat_normal, -direction, s.front);
    const Color expected = bsdf.unrefracted_transmittance();
    const Color seen = Coverage(scene, textures, media).pass(hit, direction).transmittance;
    EXPECT_GT(expected.minCoeff(), 0.0f);
    EXPECT_TRUE(seen.isApprox(expected, 1e-5f)) << seen.transpose() << " and " << expected.transpose();
  }
}

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
