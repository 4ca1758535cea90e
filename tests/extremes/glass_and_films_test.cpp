// Mirrors, glass, films, anisotropic metal, cloth and nested media at the ends of their ranges.

#include <gtest/gtest.h>

#include <functional>

#include "renderer/surface/media.h"
#include "tests/extremes/pictures.h"
#include "tests/support/materials.h"

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

TEST(Glass, ABallThatAbsorbsNothingIsInvisibleInAWhiteSky) {
  for (const float ior : {1.0f, 1.0001f, 1.019f, 1.5f, 3.0f}) {
    for (const float roughness : {0.0f, 1e-4f, 0.0299f, 0.03f, 0.05f}) {
      // Each path that leaves carries 1, whatever its length; 0.1 % are still inside after 200 events.
      EXPECT_LT(look_at_ball([&](Material& m) { m = solid_glass(ior, roughness); }, 24, 200).off, 0.02)
          << ior << " " << roughness;
    }
  }
}

TEST(Glass, SmoothMirrorsReflectAllLight) {
  // At about 0.03 the lobe stops being a delta.
  for (const float roughness : {0.0f, 1e-4f, 0.0299f, 0.03f}) {
    const auto metal = [&](Material& m) { m.metallic = 1.0f, m.roughness = roughness; };
    EXPECT_LT(look_at_ball(metal, 16, 8).off, 1e-3) << roughness;
  }
}

/// Sheets of glass in a row, or each nested in the previous one.
Rendered sheets(float ior, int layers, bool nested) {
  SceneBuilder builder;
  const int m = builder.material(solid_glass(ior));
  for (int i = 0; i < layers; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(layers);
    const float front = 1.0f - share;
    const float back = nested ? -front : front - 0.5f / static_cast<float>(layers);
    // The boxes are wide: a cube traps light by total internal reflection.
    builder.box(m, Vec3(-20, -20, back), Vec3(20, 20, front));
  }
  // Without roulette each path that leaves carries exactly 1.
  RenderOptions options = white_sky(1, 60000);
  options.min_depth = 60000;
  return render(builder.scene(), options);
}

double worst_pixel(const Rendered& picture) {
  double error = 0.0;
  for (const float v : picture.values) error = std::max(error, std::abs(static_cast<double>(v) - 1.0));
  return error;
}

TEST(Glass, HundredsOfSheetsLoseNoLightInARowAndNested) {
  for (const float ior : {1.0f, 1.5f, 3.0f}) {
    for (const auto& [layers, nested] : {std::pair{300, false}, {1, true}, {16, true}, {300, true}}) {
      const Rendered picture = sheets(ior, layers, nested);
      EXPECT_LT(worst_pixel(picture), 0.01) << ior << " " << layers << " mean " << picture.mean();
    }
  }
}

// Shells of one object are no media of their own: each refracts as from air, so that deep inside light is
// reflected totally and ends at the depth limit.
TEST(Glass, NestedBallsAddNoLight) {
  for (const float ior : {1.0f, 1.5f, 3.0f}) {
    SceneBuilder builder;
    const int m = builder.material(solid_glass(ior));
    for (int i = 0; i < 300; ++i) {
      builder.sphere(m, Vec3::Zero(), 1.0f - static_cast<float>(i) / 300.0f, 48, i % 2 == 0);
    }
    RenderOptions options = white_sky(4, 1000);
    options.min_depth = 1000;
    const Rendered picture = render(builder.scene(), options);
    if (ior == 1.0f) {
      EXPECT_LT(worst_pixel(picture), 1e-5);
    }
    for (const float v : picture.values) EXPECT_LT(v, 1.01f);
  }
}

/// Mean radiance of a wall that a lamp or a sun lights through a stack of panes.
double light_behind_panes(int panes, float ior, bool sun, DirectLight direct) {
  SceneBuilder builder;
  scene::Material pane = solid_glass(ior);
  pane.thickness = 0.0f;
  pane.specular = 0.0f;  // else Schlick's curve reflects at grazing angles whatever the index
  const int p = builder.material(pane);
  for (int i = 0; i < panes; ++i) {
    builder.quad(p, Vec3(-50, -50, 0.01f * static_cast<float>(i + 1)), Vec3(100, 0, 0), Vec3(0, 100, 0));
  }
  const int wall = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(wall, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  if (sun) {
    builder.scene().lights.push_back(testing::sun(Vec3(0, 0, -1)));
  } else {
    const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Ones()));
    builder.quad(lamp, Vec3(-40, 40, 20), Vec3(80, 0, 0), Vec3(0, -80, 0));
  }
  RenderOptions options = white_sky(16, 1);
  options.environment.constant.setZero();
  options.direct = direct;
  options.camera.look_at = LookAt{{0, 0, 0.005f}, {0, 0.002f, 0}, {0, 1, 0}};
  return render(builder.scene(), options).mean();
}

TEST(Glass, PanesOfIndexOneDoNotDarkenLamps) {
  const double lamp = light_behind_panes(0, 1.0f, false, DirectLight::bsdf);
  const double sun = light_behind_panes(0, 1.0f, true, DirectLight::mis);
  for (const int panes : {1, 8, 64, 65, 200}) {
    for (const DirectLight direct : {DirectLight::mis, DirectLight::bsdf}) {
      const double error = std::abs(light_behind_panes(panes, 1.0f, false, direct) / lamp - 1.0);
      EXPECT_LT(error, 0.03) << panes;
    }
    const double error = std::abs(light_behind_panes(panes, 1.0f, true, DirectLight::mis) / sun - 1.0);
    if (panes <= 64) {  // behind more, a sun, point or spot light counts as dark
      EXPECT_LT(error, 1e-5);
    }
  }
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
      const Material m = solid_glass(1.3f + step * static_cast<float>(i % 3));
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
