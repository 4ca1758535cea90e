// White furnaces through the whole path tracer: a smooth-shaded ball that absorbs nothing, under a sky of
// radiance 1, is invisible. Energy that the BSDF, its shading normals or the light sampling lose or add shows
// as a shape.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "renderer/render.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {

namespace {

using scene::Material;
using testing::Moments;
using testing::SceneBuilder;

constexpr int kBallSize = 34;
constexpr float kPixelsPerRadius = 14.0f;

struct FurnaceMaterial {
  std::string name;
  std::function<void(Material&)> make;
};

Material white() {
  Material m;
  m.metallic = 0.0f;
  m.roughness = 0.0f;
  return m;
}

std::vector<FurnaceMaterial> cases() {
  std::vector<FurnaceMaterial> all;
  for (int percent : {0, 15, 45, 100}) {
    const float roughness = 0.01f * static_cast<float>(percent);
    const std::string end = std::to_string(percent);
    all.push_back({"Metal" + end, [=](Material& m) { m.metallic = 1.0f, m.roughness = roughness; }});
    all.push_back({"Dielectric" + end, [=](Material& m) { m.roughness = roughness; }});
    all.push_back({"GlassBall" + end,
                   [=](Material& m) { m.roughness = roughness, m.transmission = 1.0f, m.thickness = 1.0f; }});
    all.push_back({"ThinGlass" + end, [=](Material& m) {
                     m.roughness = roughness, m.transmission = 1.0f, m.double_sided = true;
                   }});
  }
  all.push_back({"HalfTransmitting",
                 [](Material& m) { m.roughness = 0.4f, m.transmission = 0.5f, m.thickness = 1.0f; }});
  all.push_back({"Diamond", [](Material& m) { m.transmission = 1.0f, m.thickness = 1.0f, m.ior = 2.4f; }});
  all.push_back({"DispersingGlass", [](Material& m) {
                   m.transmission = 1.0f, m.thickness = 1.0f, m.ior = 1.7f, m.dispersion = 2.0f;
                 }});
  all.push_back({"SoapBubble", [](Material& m) {
                   m.transmission = 1.0f, m.double_sided = true, m.iridescence = 1.0f,
                   m.film_thickness_maximum = 480.0f;
                 }});
  all.push_back({"Cloth", [](Material& m) {
                   m.roughness = 0.6f, m.diffuse_transmission = 0.5f, m.double_sided = true;
                 }});
  all.push_back({"MilkyGlass", [](Material& m) {
                   m.roughness = 0.3f, m.transmission = 0.5f, m.diffuse_transmission = 0.5f,
                   m.thickness = 1.0f;
                 }});
  const auto body = [](Material& m, float distance, float g) {
    m.thickness = 1.0f, m.attenuation_distance = distance, m.attenuation_color = Color(0.3f, 0.5f, 0.7f);
    m.multiscatter_color = Color::Ones(), m.scatter_anisotropy = g;
  };
  all.push_back(
      {"ThinMilk", [=](Material& m) { m.transmission = 1.0f, m.ior = 1.33f, body(m, 2.0f, 0.0f); }});
  all.push_back(
      {"DenseMilk", [=](Material& m) { m.transmission = 1.0f, m.ior = 1.33f, body(m, 0.1f, 0.7f); }});
  all.push_back({"BackwardJelly",
                 [=](Material& m) { m.roughness = 0.4f, m.transmission = 1.0f, body(m, 0.5f, -0.8f); }});
  all.push_back({"Wax", [=](Material& m) { m.diffuse_transmission = 1.0f, body(m, 0.1f, 0.0f); }});
  all.push_back({"SmoothCoatOnMatte", [](Material& m) { m.roughness = 1.0f, m.clearcoat = 1.0f; }});
  all.push_back({"RoughCoatOnMetal", [](Material& m) {
                   m.metallic = 1.0f, m.roughness = 0.3f, m.clearcoat = 1.0f, m.clearcoat_roughness = 0.4f;
                 }});
  all.push_back({"Sheen", [](Material& m) {
                   m.roughness = 0.8f, m.sheen_color = Color::Constant(1.0f), m.sheen_roughness = 0.4f;
                 }});
  all.push_back({"Lambert", [](Material& m) { m.roughness = 1.0f, m.specular = 0.0f; }});
  return all;
}

/// The ball in the middle of the picture, seen from so far that its radius is kPixelsPerRadius everywhere.
Picture ball(const Material& material, int spp) {
  SceneBuilder builder;
  builder.sphere(builder.material(material), Vec3(0, 0, 0), 1.0f, 96, true);
  RenderOptions options;
  options.width = options.height = kBallSize;
  options.spp = spp;
  // Glass keeps some light inside for long; roulette would only add noise.
  options.max_depth = options.min_depth = 100;
  options.sampler = SamplerKind::independent;
  options.filter = PixelFilter::box;
  options.aovs = {Aov::variance};
  options.environment.constant = Color::Constant(1.0f);
  LookAt view;
  view.eye = Vec3(0, 30, 40);
  options.camera.look_at = view;
  options.camera.look_at->target = Vec3::Zero();
  options.camera.fov_degrees = 2.0f * std::atan(0.5f * kBallSize / kPixelsPerRadius / 50.0f) * 180.0f / kPi;
  return Renderer(builder.scene(), options).render();
}

/// Distance of a pixel's centre from the middle of the ball, in radii.
float radius_at(int x, int y) {
  return std::hypot(static_cast<float>(x) + 0.5f - 0.5f * kBallSize,
                    static_cast<float>(y) + 0.5f - 0.5f * kBallSize) /
         kPixelsPerRadius;
}

/// Radii between which the silhouette lies; the mesh is inscribed.
constexpr float kInner = 0.92f;
constexpr float kOuter = 1.08f;

/// Standard errors that none of some ten thousand pixels may exceed.
constexpr double kErrors = 5.7;

class WhiteFurnace : public ::testing::TestWithParam<FurnaceMaterial> {};

TEST_P(WhiteFurnace, ABallThatAbsorbsNothingIsInvisible) {
  Material material = white();
  GetParam().make(material);
  const Picture picture = ball(material, 128);
  const std::vector<float>& values = picture.layers[0].values;
  const std::vector<float>& variances = picture.find("variance")->values;
  // All pixels of a ring see the same. A pixel that has missed a rare lobe finds its variance too small.
  std::array<Moments, 64> ring_variance;
  Moments inner;
  Moments rim;
  Moments sky;
  const auto ring = [](float radius) { return static_cast<std::size_t>(radius * 12.0f); };
  for (int y = 0; y < kBallSize; ++y) {
    for (int x = 0; x < kBallSize; ++x) {
      const std::size_t i = static_cast<std::size_t>(3 * (y * kBallSize + x));
      const float r = radius_at(x, y);
      (r < kInner ? inner : r < kOuter ? rim : sky).add(values[i]);
      ring_variance[ring(r)].add(variances[i]);
    }
  }
  double worst = 0.0;
  for (int y = 0; y < kBallSize; ++y) {
    for (int x = 0; x < kBallSize; ++x) {
      const std::size_t i = static_cast<std::size_t>(3 * (y * kBallSize + x));
      const float r = radius_at(x, y);
      if (r >= kInner) continue;
      const double variance = std::max<double>(variances[i], ring_variance[ring(r)].mean());
      worst = std::max(worst, std::abs(values[i] - 1.0) - kErrors * std::sqrt(variance));
    }
  }
  EXPECT_LT(worst, 0.01) << "difference of one pixel beyond its noise";
  EXPECT_LT(std::abs(inner.mean() - 1.0) - 3.0 * inner.standard_error(), 0.005) << "mean " << inner.mean();
  EXPECT_LT(std::abs(rim.mean() - 1.0) - 3.0 * rim.standard_error(), 0.015)
      << "mean of the rim " << rim.mean();
  EXPECT_EQ(sky.mean(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(All, WhiteFurnace, ::testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST(MaterialsStat, AbsorptionInGlassIsVisibleInTheFurnace) {
  Material material = white();
  material.transmission = 1.0f;
  material.thickness = 1.0f;
  material.ior = 1.0f;
  material.attenuation_color = Color(0.25f, 0.5f, 1.0f);
  material.attenuation_distance = 2.0f;
  const Picture picture = ball(material, 64);
  // With an index of 1 rays go straight on, by the law of Beer over the chord 2 sqrt(1 - r^2).
  for (int y = 0; y < kBallSize; ++y) {
    for (int x = 0; x < kBallSize; ++x) {
      const float r = radius_at(x, y);
      if (r > 0.85f) continue;
      const float chord = 2.0f * std::sqrt(1.0f - r * r);
      for (std::size_t c = 0; c < 3; ++c) {
        const float expected =
            std::pow(material.attenuation_color[static_cast<Eigen::Index>(c)], chord / 2.0f);
        EXPECT_NEAR(picture.layers[0].values[static_cast<std::size_t>(3 * (y * kBallSize + x)) + c], expected,
                    0.01f);
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
