// Lights at the extremes of scale, brightness and geometry, and the materials that emit light.

#include "renderer/light/lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/sampling/warp.h"
#include "tests/support/light_scenes.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::add_light;
using testing::LitScene;
using testing::Triangle;

const Triangle kLamp{Vec3(-1, 2, -1), Vec3(1, 2, -1), Vec3(0, 2, 1)};  // faces down

Vec3 random_vector(testing::Random& random, float size) {
  const float x = random.uniform_float() - 0.5f;
  const float y = random.uniform_float() - 0.5f;
  return 2.0f * size * Vec3(x, y, random.uniform_float() - 0.5f);
}

TEST(LightsTest, AnEmptySceneHasNoSamples) {
  const LitScene lit{scene::Scene{}};
  EXPECT_TRUE(lit.lights.empty());
  EXPECT_EQ(lit.lights.sample(Vec3::Zero(), Vec3::UnitY(), 0.5f, Vec2(0.5f, 0.5f)).pdf, 0.0f);
  EXPECT_EQ(lit.lights.pdf_environment(Vec3::Zero(), Vec3::UnitY(), Vec3::UnitY()), 0.0f);
}

TEST(LightsTest, SamplesAreFiniteAndAgreeWithTheDensityAtEveryScale) {
  testing::Random random(1);
  for (const LightSelection selection : {LightSelection::tree, LightSelection::power}) {
    for (const float size : {1e-3f, 1.0f, 1e6f}) {
      for (const float emission : {1e-6f, 1.0f, 1e6f}) {
        scene::Scene scene;
        for (int i = 0; i < 40; ++i) {
          // From big to slivers and specks, a hundred-thousandth of the scene.
          const Vec3 a = random_vector(random, size);
          const float extent = size * std::pow(10.0f, -5.0f * random.uniform_float());
          add_light(scene,
                    {{a, a + random_vector(random, extent), a + random_vector(random, 0.01f * extent)}},
                    Color(emission, emission, emission), i % 2 == 0);
        }
        const LitScene lit(std::move(scene), selection);
        ASSERT_FALSE(lit.lights.empty());
        int found = 0;
        for (int i = 0; i < 4000; ++i) {
          const Vec3 p = random_vector(random, size);
          const Vec3 n = sample_uniform_sphere(testing::next_2d(random));
          const LightSample sample = testing::draw_light(lit.lights, p, n, random);
          if (!(sample.pdf > 0.0f)) continue;
          ++found;
          ASSERT_TRUE(std::isfinite(sample.pdf) && std::isfinite(sample.distance));
          ASSERT_TRUE(sample.radiance.isFinite().all());
          ASSERT_NEAR(sample.wi.norm(), 1.0f, 1e-5f);
          // Some light gives this density; slivers decide differently within rounding, so any may.
          double density = 0.0;
          for (std::uint32_t light = 0; light < 40; ++light) {
            const auto pdf =
                static_cast<double>(lit.lights.pdf_triangle(p, n, light, 0, sample.wi, sample.distance));
            ASSERT_TRUE(std::isfinite(pdf) && pdf >= 0.0);
            density = std::max(density, pdf);
          }
          ASSERT_GT(density, 0.0);
        }
        EXPECT_GT(found, 400);
      }
    }
  }
}

TEST(LightsTest, PointsOnTheLightAndInItsPlaneAreHarmless) {
  scene::Scene scene;
  add_light(scene, {kLamp}, Color(1, 1, 1), true);
  add_light(scene, testing::quad(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)), Color(1, 1, 1));
  const LitScene lit(std::move(scene));
  testing::Random random(2);
  std::vector<Vec3> points{
      kLamp[0],      kLamp[1],      0.5f * (kLamp[0] + kLamp[1]), Vec3(0, 2, 0),
      Vec3(7, 2, 3), Vec3(0, 0, 0), Vec3(0.5f, 0, 0.5f),          Vec3(0.2f, 1e-7f, 0.3f)};
  for (const Vec3& p : points) {
    for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 0)}) {
      for (int i = 0; i < 500; ++i) {
        const LightSample sample = testing::draw_light(lit.lights, p, n, random);
        ASSERT_TRUE(std::isfinite(sample.pdf) && sample.pdf >= 0.0f);
        if (sample.pdf > 0.0f) {
          ASSERT_TRUE(sample.radiance.isFinite().all() && sample.wi.allFinite());
        }
        const float pdf = lit.lights.pdf_triangle(p, n, 0, 0, Vec3(1, 0, 0), 1.0f);
        ASSERT_TRUE(std::isfinite(pdf));
        ASSERT_TRUE(std::isfinite(lit.lights.pdf_triangle(p, n, 0, 0, Vec3(0, 1, 0), 0.0f)));
      }
    }
  }
}

TEST(LightsTest, OnlyEmittersCount) {
  scene::Scene scene;
  const std::uint32_t lamp = add_light(scene, {kLamp, {kLamp[0], kLamp[0], kLamp[1]}}, Color(1, 1, 1));
  const std::uint32_t dark = add_light(scene, {kLamp}, Color(0, 0, 0));
  scene::Material unlit;
  unlit.emission = Color(1, 1, 1);
  unlit.unlit = true;
  const std::uint32_t sign = add_light(scene, {kLamp}, unlit);
  const LitScene lit(std::move(scene));
  EXPECT_EQ(lit.lights.emissive_triangles(), 1u);
  EXPECT_FALSE(lit.lights.has_delta());
  EXPECT_EQ(lit.lights.sample_delta(Vec3::Zero(), Vec3::UnitY(), 0.5f, Vec2(0.5f, 0.5f)).pdf, 0.0f);
  const auto pdf = [&](std::uint32_t instance, std::uint32_t primitive, const Vec3& p, const Vec3& wi) {
    return lit.lights.pdf_triangle(p, Vec3::Zero(), instance, primitive, wi, 2.0f);
  };
  EXPECT_GT(pdf(lamp, 0, Vec3(0, 0, 0), Vec3(0, 1, 0)), 0.0f);
  EXPECT_EQ(pdf(lamp, 0, Vec3(0, 4, 0), Vec3(0, -1, 0)), 0.0f) << "the back of a one-sided lamp";
  EXPECT_EQ(pdf(lamp, 1, Vec3(0, 0, 0), Vec3(0, 1, 0)), 0.0f) << "a degenerate triangle";
  EXPECT_EQ(pdf(dark, 0, Vec3(0, 0, 0), Vec3(0, 1, 0)), 0.0f);
  EXPECT_EQ(pdf(sign, 0, Vec3(0, 0, 0), Vec3(0, 1, 0)), 0.0f);
}

/// The lamp's texture: left half black, right half white in emission, or in alpha.
LitScene textured_lamp(bool emission, scene::AlphaMode mode, float base_alpha) {
  scene::Scene scene;
  scene::Material material;
  material.emission = Color(2, 4, 6);
  scene::Image image{.name = "halves", .width = 16, .height = 1, .channels = 4, .pixels = {}};
  for (int x = 0; x < 16; ++x) {
    const std::uint8_t value = x < 8 ? 0 : 255;
    for (int c = 0; c < 3; ++c) image.pixels.push_back(emission ? value : std::uint8_t{255});
    image.pixels.push_back(emission ? std::uint8_t{255} : value);
  }
  scene.images.push_back(image);
  scene::Texture texture;
  texture.image = 0;
  texture.wrap_s = scene::Wrap::clamp_to_edge;
  scene.textures.push_back(texture);
  (emission ? material.emission_texture : material.base_color_texture).texture = 0;
  material.alpha_mode = mode;
  material.base_alpha = base_alpha;
  add_light(scene, testing::quad(Vec3(0, 2, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)), material);
  scene.meshes[0].uv0 = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)};
  return LitScene(std::move(scene));
}

TEST(LightsTest, EmissionTextureAndAlphaShapeTheLight) {
  struct Case {
    bool emission;
    scene::AlphaMode mode;
    float base_alpha;
    float bright;  ///< part of the emission where the texture is white
  };
  for (const Case& c :
       {Case{true, scene::AlphaMode::opaque, 0.3f, 1.0f}, Case{false, scene::AlphaMode::mask, 1.0f, 1.0f},
        Case{false, scene::AlphaMode::mask, 0.4f, 0.0f}, Case{false, scene::AlphaMode::blend, 0.25f, 0.25f},
        Case{true, scene::AlphaMode::blend, 0.25f, 0.25f}}) {
    const LitScene lit = textured_lamp(c.emission, c.mode, c.base_alpha);
    EXPECT_EQ(lit.lights.emissive_triangles(), 2u);
    testing::Random random(3);
    int bright = 0;
    int dark = 0;
    for (int i = 0; i < 400; ++i) {
      const Vec3 p(0.5f, 0, 0.5f);
      const LightSample sample = testing::draw_light(lit.lights, p, Vec3::UnitY(), random);
      ASSERT_GT(sample.pdf, 0.0f);
      const float x = (p + sample.distance * sample.wi).x();
      if (std::abs(x - 0.5f) < 0.07f) continue;  // within the filter's reach
      ++(x > 0.5f ? bright : dark);
      const Color expected = x > 0.5f ? Color(Color(2, 4, 6) * c.bright) : Color(0, 0, 0);
      ASSERT_TRUE(sample.radiance.isApprox(expected, 1e-3f) ||
                  (sample.radiance - expected).abs().maxCoeff() < 1e-4f)
          << sample.radiance.transpose() << " at " << x;
    }
    EXPECT_GT(bright, 50);
    EXPECT_GT(dark, 50);
  }
}

TEST(LightsTest, ABlackTextureIsNoLight) {
  LitScene lit = [] {
    scene::Scene scene;
    scene::Material material;
    material.emission = Color(1, 1, 1);
    scene.images.push_back({.name = "black", .width = 1, .height = 1, .channels = 1, .pixels = {0}});
    scene.textures.push_back({.image = 0});
    material.emission_texture.texture = 0;
    add_light(scene, {kLamp}, material);
    return LitScene(std::move(scene));
  }();
  EXPECT_TRUE(lit.lights.empty());
  EXPECT_EQ(lit.lights.pdf_triangle(Vec3::Zero(), Vec3::UnitY(), 0, 0, Vec3::UnitY(), 2.0f), 0.0f);
}

// A light that is chosen less often than once in 2^24 lies between the numbers that a float can distinguish;
// the second number gives more bits to the first.
TEST(LightsTest, LightsBetweenTheStepsOfTheNumberAreStillChosen) {
  scene::Scene scene;
  const auto lamp = [](float x) { return Triangle{Vec3(x, 2, 0), Vec3(x + 0.1f, 2, 0), Vec3(x, 2, 0.1f)}; };
  add_light(scene, {lamp(0.0f)}, Color(1, 1, 1));
  add_light(scene, {lamp(0.5f)}, Color(1e-9f, 1e-9f, 1e-9f));
  const LitScene lit(std::move(scene), LightSelection::power);
  // The table's second half belongs to the dim lamp for its first billionth, then to the bright one.
  const LightSample bright = lit.lights.sample(Vec3::Zero(), Vec3::UnitY(), 0.5f, Vec2(0.5f, 0.5f));
  const LightSample dim = lit.lights.sample(Vec3::Zero(), Vec3::UnitY(), 0.5f, Vec2(0.0f, 0.5f));
  EXPECT_EQ(bright.radiance.x(), 1.0f);
  EXPECT_EQ(dim.radiance.x(), 1e-9f);
  EXPECT_GT(dim.pdf, 0.0f);
}

TEST(LightsTest, AProfileTurnsWithItsLight) {
  // 60 candela along the aim, none at 90 degrees in x, 30 there in y.
  scene::PunctualLight light{
      .intensity = Color(4, 2, 8), .position = Vec3(0, 2, 0), .direction = Vec3(0, 0, 1)};
  light.side = Vec3(0, 1, 0);
  light.profile = std::make_shared<const scene::IesProfile>(
      "TILT=NONE\n1 -1 1 2 2 1 2 0 0 0 1 1 1  0 90  0 90  60 0 60 30");
  scene::Scene scene;
  scene.lights.push_back(light);
  const LitScene lit(std::move(scene));
  const auto sent = [&](const Vec3& offset) {
    const LightSample s = lit.lights.sample(Vec3(0, 2, 0) + offset, Vec3::Zero(), 0.5f, Vec2(0.5f, 0.5f));
    EXPECT_FALSE(s.pdf > 0.0f && !s.delta);
    return s.pdf > 0.0f ? s.radiance.x() : 0.0f;
  };
  EXPECT_NEAR(sent({0, 0, 2}), 1.0f, 1e-5f);
  EXPECT_NEAR(sent({0, 2, 0}), 0.0f, 1e-5f);
  EXPECT_NEAR(sent({2, 0, 0}), 0.5f, 1e-5f);
  EXPECT_NEAR(sent({-2, 0, 0}), 0.5f, 1e-5f);
  EXPECT_EQ(sent({0, 0, -2}), 0.0f);
}

/// A point, a spot, one that misses the origin, three suns and a panel. Each has a colour of its own.
scene::Scene delta_scene() {
  scene::Scene scene;
  add_light(scene, {kLamp}, Color(9, 9, 9));
  const auto add = [&](scene::LightType type, const Color& intensity, const Vec3& at, const Vec3& direction) {
    scene::PunctualLight light;
    light.type = type;
    light.intensity = intensity;
    light.position = at;
    light.direction = direction.normalized();
    light.cos_inner = 0.9f;
    light.cos_outer = 0.8f;
    scene.lights.push_back(light);
  };
  using scene::LightType;
  add(LightType::point, Color(3, 1, 2), Vec3(0, 2, 0), Vec3::Zero());
  add(LightType::point, Color(1, 5, 1), Vec3(3, 1, 0), Vec3::UnitX());
  add(LightType::point, Color(8, 1, 3), Vec3(0, -1, 1), Vec3::UnitX());  // below the floor
  add(LightType::spot, Color(4, 7, 1), Vec3(0, 4, 3), Vec3(0, -4, -3));
  add(LightType::spot, Color(6, 6, 7), Vec3(0, 4, -3), Vec3(0, 1, 0));  // looks away
  add(LightType::directional, Color(0.5f, 0.1f, 0.2f), Vec3::Zero(), Vec3(0, -1, 0));
  add(LightType::directional, Color(0.1f, 0.7f, 0.3f), Vec3::Zero(), Vec3(1, -1, 0));
  add(LightType::directional, Color(0.9f, 0.2f, 0.2f), Vec3::Zero(), Vec3(0, 1, 0));  // from below
  return scene;
}

/// Their whole light at the origin, weighted by the cosine with n; by 1 where n is zero.
Color delta_irradiance(const Vec3& n) {
  const auto seen = [&](const Color& irradiance, const Vec3& to_light) -> Color {
    return irradiance * (n.isZero(0.0f) ? 1.0f : std::max(0.0f, n.dot(to_light.normalized())));
  };
  Color sum = Color::Zero();
  sum += seen(Color(3, 1, 2) / 4.0f, Vec3(0, 2, 0));
  sum += seen(Color(1, 5, 1) / 10.0f, Vec3(3, 1, 0));
  sum += seen(Color(8, 1, 3) / 2.0f, Vec3(0, -1, 1));
  sum += seen(Color(4, 7, 1) / 25.0f, Vec3(0, 4, 3));
  sum += seen(Color(0.5f, 0.1f, 0.2f), Vec3(0, 1, 0));
  sum += seen(Color(0.1f, 0.7f, 0.3f), Vec3(-1, 1, 0));
  sum += seen(Color(0.9f, 0.2f, 0.2f), Vec3(0, -1, 0));
  return sum;
}

TEST(LightsTest, DeltaSamplesAddUpToAllDeltaLightsAndNothingElse) {
  constexpr int kNumbers = 1 << 17;
  for (const LightSelection selection : {LightSelection::tree, LightSelection::power}) {
    const LitScene lit(delta_scene(), selection);
    EXPECT_TRUE(lit.lights.has_delta());
    for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(0.6f, 0, 0.8f)}) {
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      for (int i = 0; i < kNumbers; ++i) {
        const float u_select = (static_cast<float>(i) + 0.5f) / kNumbers;
        const LightSample sample = lit.lights.sample_delta(Vec3::Zero(), n, u_select, Vec2(0.5f, 0.5f));
        if (!(sample.pdf > 0.0f)) continue;
        ASSERT_TRUE(sample.delta);
        ASSERT_NEAR(sample.wi.norm(), 1.0f, 1e-6f);
        const float cosine = n.isZero(0.0f) ? 1.0f : std::max(0.0f, n.dot(sample.wi));
        sum += (sample.radiance * (cosine / sample.pdf)).cast<double>();
      }
      // Each light's share of the numbers is right to within one of them.
      for (int k = 0; k < 3; ++k) {
        const double expected = static_cast<double>(delta_irradiance(n)[k]);
        EXPECT_NEAR(sum[k] / kNumbers, expected, 1e-3 * expected) << n.transpose() << ", channel " << k;
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
