// The light of scenes without light.

#include "renderer/light/soft_sky.h"

#include <gtest/gtest.h>

#include "renderer/light/environment.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

TEST(SoftSky, OnlyScenesWithReflectingSurfacesAndWithoutLightsNeedIt) {
  SceneBuilder builder;
  const int clay = builder.material(SceneBuilder::lambert(Color::Ones()));
  EXPECT_FALSE(needs_light(builder.scene())) << "an empty scene";
  builder.quad(clay, Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0));
  EXPECT_TRUE(needs_light(builder.scene()));
  scene::Scene lit = builder.scene();
  lit.lights.emplace_back();
  EXPECT_FALSE(needs_light(lit));
  scene::Scene glowing = builder.scene();
  glowing.materials[0].emission = Color(0.0f, 0.1f, 0.0f);
  EXPECT_FALSE(needs_light(glowing));
  scene::Scene unlit = builder.scene();
  unlit.materials[0].unlit = true;
  EXPECT_FALSE(needs_light(unlit));
  builder.scene().materials[0].unlit = true;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(0, 0, 1), Vec3(1, 0, 0),
               Vec3(0, 1, 0));
  EXPECT_TRUE(needs_light(builder.scene())) << "one surface is unlit, the other is not";
}

// A surface of 1 m stands 1 m before a glowing one.
TEST(SoftSky, WhatGlowsLightsTheSidesThatMaterialsHave) {
  const auto needs = [](bool towards, bool double_sided) {
    SceneBuilder builder;
    scene::Material label = SceneBuilder::lambert(Color::Zero());
    label.emission = Color::Ones();
    builder.quad(builder.material(label), Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, 1, 0));
    scene::Material clay = SceneBuilder::lambert(Color::Ones());
    clay.double_sided = double_sided;
    const Vec3 x = towards ? Vec3(0, 1, 0) : Vec3(1, 0, 0), y = towards ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    builder.quad(builder.material(clay), Vec3::Zero(), x, y);
    return needs_light(builder.scene());
  };
  EXPECT_FALSE(needs(true, false));
  EXPECT_TRUE(needs(false, false));
  EXPECT_FALSE(needs(false, true));
}

TEST(SoftSky, MakesWhiteSurfacesNeitherDarkNorOverexposed) {
  EnvironmentOptions options;
  options.automatic = true;
  const Environment sky(options);
  options.scale = 2.0f;
  const Environment twice(options);
  for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(1, 0, 0)}) {
    Color reflected = Color::Zero();
    constexpr int kTheta = 64, kPhi = 128;
    for (int i = 0; i < kTheta; ++i) {
      for (int j = 0; j < kPhi; ++j) {
        const float theta = kPi * (static_cast<float>(i) + 0.5f) / kTheta;
        const float phi = 2.0f * kPi * (static_cast<float>(j) + 0.5f) / kPhi;
        const Vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        const float solid_angle = std::sin(theta) * (kPi / kTheta) * (2.0f * kPi / kPhi);
        reflected += sky.radiance(d) * (std::max(0.0f, n.dot(d)) * solid_angle / kPi);
        ASSERT_TRUE(twice.radiance(d).isApprox(2.0f * sky.radiance(d), 1e-5f));
      }
    }
    EXPECT_GT(reflected.minCoeff(), 0.2f) << n.transpose();
    EXPECT_LT(reflected.maxCoeff(), 1.2f) << n.transpose();
  }
}

}  // namespace
}  // namespace gatelight::renderer
