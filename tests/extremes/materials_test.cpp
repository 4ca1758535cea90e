// Films, anisotropic metal, cloth, dispersing glass and nested media at the ends of their ranges.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/extremes/extreme.h"
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

TEST(Materials, FilmsOfAnyThicknessAndIndexAddNoLight) {
  double worst_metal = 0.0, least = 1.0, most = 1.0;
  int tried = 0;
  for (const float thickness : {0.0f, 1e-3f, 100.0f, 1e3f, 1e6f, 1e30f}) {
    for (const float ior : {1.0f, 1.33f, 3.0f, 1e6f}) {
      for (const float roughness : {0.0f, 0.03f, 1.0f}) {
        const auto film = [&](Material& m) {
          m.roughness = roughness;
          m.iridescence = 1.0f;
          m.film_ior = ior;
          m.film_thickness_maximum = thickness;
        };
        worst_metal =
            std::max(worst_metal, look_at_ball([&](Material& m) { film(m), m.metallic = 1.0f; }, 16, 8).off);
        const double mean = look_at_ball(film, 16, 8).mean;
        least = std::min(least, mean);
        most = std::max(most, mean);
        tried += 2;
      }
    }
  }
  EXPECT_LT(worst_metal, 0.05);
  EXPECT_GT(least, 0.7);
  EXPECT_LT(most, 1.05);
  report_extreme("films on white balls in a white sky",
                 "0 to 1e30 nm, index 1 to 1e6, roughness 0 to 1, metal and dielectric",
                 fmt::format("{} balls: metal off by {:.1e} in the mean (bound 0.05); dielectric from {:.2f} "
                             "to {:.3f} (bounds 0.7, "
                             "1.05): light that a film of high index reflects is lost to the base below it",
                             tried, worst_metal, least, most),
                 "");
}

TEST(Materials, AnisotropicMetalOfAnyStrengthReflectsAllLight) {
  double worst = 0.0;
  int tried = 0;
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
      worst = std::max(worst, seen.off);
      ++tried;
    }
  }
  report_extreme("anisotropic metal in a white sky", "strength 0, 1e-6, 0.5, 1; roughness 0 to 1",
                 fmt::format("{} balls, mean off by {:.1e} (bound 0.015)", tried, worst), "");
}

TEST(Materials, ClothOfAnyDiffuseTransmissionLosesNoLight) {
  double worst = 0.0;
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
      worst = std::max(worst, seen.off);
    }
  }
  report_extreme("a hollow ball of cloth in a white sky",
                 "a share of 0, 1e-6, 0.5, 1 goes through; thin and with an inside",
                 fmt::format("8 balls, mean off by {:.1e} (bound 0.01)", worst), "");
}

TEST(Materials, GlassOfAnyDispersionLosesNoLight) {
  double worst = 0.0;
  for (const float dispersion : {0.0f, 1e-6f, 1.0f, 20.0f, 1e6f, 1e30f}) {
    const Seen seen = look_at_ball([&](Material& m) {
      m.transmission = m.thickness = 1.0f;
      m.dispersion = dispersion;
    });
    EXPECT_LT(seen.off, 0.03) << dispersion;
    worst = std::max(worst, seen.off);
  }
  report_extreme("a dispersing ball in a white sky", "20 over the Abbe number: 0, 1e-6, 1, 20, 1e6, 1e30",
                 fmt::format("6 balls, mean off by {:.1e} (bound 0.03)", worst), "");
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
  double worst = 0.0;
  for (const int count : {2, MediumStack::kMax}) {
    for (const float step : {0.0f, 0.3f}) {
      const Seen seen = balls(count, step);
      EXPECT_LT(seen.off, 0.01) << count << " " << step;
      worst = std::max(worst, seen.off);
    }
  }
  const double brightest = balls(100, 0.3f).brightest;
  EXPECT_LT(brightest, 10.0);
  report_extreme(
      "nested balls of three indices, as objects", "2, 8 and 100, in a white sky",
      fmt::format("up to 8: mean off by {:.1e} (bound 0.01); 100: finite, no pixel above {:.2f} (bound 10)",
                  worst, brightest),
      "of more than 8 bodies around a point the outermost are forgotten: beyond them light leaves into air");
}

}  // namespace
}  // namespace gatelight::renderer
