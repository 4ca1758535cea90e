// Films, anisotropic metal, cloth, dispersing glass and nested media at the ends of their ranges.

#include <gtest/gtest.h>

#include <functional>

#include "renderer/surface/media.h"
#include "tests/extremes/pictures.h"

namespace gatelight::renderer {
namespace {

using namespace testing;
using scene::Material;

/// The largest pixel, the mean, and its distance from 1 in a white sky, where an object that absorbs nothing
/// is invisible.
struct Seen {
  double brightest = 0.0;
  double mean = 0.0;
  double off = 0.0;
};

Seen look(const scene::Scene& scene, const RenderOptions& options) {
  const Rendered picture = render(scene, options);
  EXPECT_TRUE(picture.sane());
  Seen seen{0.0, picture.mean(), std::abs(picture.mean() - 1.0)};
  for (const float v : picture.values) seen.brightest = std::max(seen.brightest, static_cast<double>(v));
  return seen;
}

Seen look_at_ball(const std::function<void(Material&)>& change, int spp = 64, int depth = 200) {
  SceneBuilder builder;
  Material m;
  m.metallic = 0.0f;
  m.roughness = 0.0f;
  change(m);
  builder.sphere(builder.material(m), Vec3::Zero(), 1.0f, 48, true);
  return look(builder.scene(), white_sky(spp, depth));
}

// Light that a film of high index reflects is lost to a dielectric base below it.
TEST(Materials, FilmsOfAnyThicknessAndIndexAddNoLight) {
  for (const float thickness : {0.0f, 1e-3f, 100.0f, 1e3f, 1e6f, 1e30f}) {
    for (const float ior : {1.0f, 1.33f, 3.0f, 1e6f}) {
      for (const float roughness : {0.0f, 0.03f, 1.0f}) {
        const auto film = [&](Material& m) {
          m.roughness = roughness;
          m.iridescence = 1.0f;
          m.film_ior = ior;
          m.film_thickness_maximum = thickness;
        };
        SCOPED_TRACE(::testing::Message() << thickness << " " << ior << " " << roughness);
        EXPECT_LT(look_at_ball([&](Material& m) { film(m), m.metallic = 1.0f; }, 16, 8).off, 0.05);
        const double mean = look_at_ball(film, 16, 8).mean;
        EXPECT_GT(mean, 0.7);
        EXPECT_LT(mean, 1.05);
      }
    }
  }
}

TEST(Materials, AnisotropicMetalOfAnyStrengthReflectsAllLight) {
  for (const float strength : {0.0f, 1e-6f, 0.5f, 1.0f}) {
    for (const float roughness : {0.0f, 1e-4f, 0.03f, 0.5f, 1.0f}) {
      const Seen seen = look_at_ball(
          [&](Material& m) {
            m.metallic = 1.0f;
            m.roughness = roughness;
            m.anisotropy = strength;
          },
          64, 8);
      EXPECT_LT(seen.off, 0.015) << strength << " " << roughness;
    }
  }
}

TEST(Materials, ClothOfAnyDiffuseTransmissionLosesNoLight) {
  for (const float share : {0.0f, 1e-6f, 0.5f, 1.0f}) {
    for (const float thickness : {0.0f, 1.0f}) {
      const Seen seen = look_at_ball(
          [&](Material& m) {
            m.roughness = 1.0f;
            m.diffuse_transmission = share;
            m.thickness = thickness;
            m.double_sided = true;
          },
          64, 400);
      EXPECT_LT(seen.off, 0.01) << share << " " << thickness;
    }
  }
}

TEST(Materials, GlassOfAnyDispersionLosesNoLight) {
  for (const float dispersion : {0.0f, 1e-6f, 1.0f, 20.0f, 1e6f, 1e30f}) {
    const Seen seen = look_at_ball([&](Material& m) {
      m.transmission = m.thickness = 1.0f;
      m.dispersion = dispersion;
    });
    EXPECT_LT(seen.off, 0.03) << dispersion;
  }
}

TEST(Materials, NestedMediaLoseNoLight) {
  const auto balls = [](int count, float step) {
    SceneBuilder builder;
    for (int i = 0; i < count; ++i) {
      Material m;
      m.metallic = m.roughness = 0.0f;
      m.transmission = m.thickness = 1.0f;
      m.ior = 1.3f + step * static_cast<float>(i % 3);
      const float radius = 1.0f - 0.9f * static_cast<float>(i) / static_cast<float>(count);
      builder.sphere(builder.material(m), Vec3::Zero(), radius, 24, true);
      builder.scene().instances.back().placement = i;
    }
    RenderOptions options = white_sky(4, 1000);
    options.min_depth = 1000;
    return look(builder.scene(), options);
  };
  for (const int count : {2, MediumStack::kMax}) {
    for (const float step : {0.0f, 0.3f}) EXPECT_LT(balls(count, step).off, 0.01) << count << " " << step;
  }
  // Of more bodies around a point the outermost are forgotten: beyond them light leaves into air.
  EXPECT_LT(balls(100, 0.3f).brightest, 10.0);
}

}  // namespace
}  // namespace gatelight::renderer
