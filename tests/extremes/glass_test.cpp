// Mirrors and glass at the ends of their ranges.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/extremes/extreme.h"
#include "tests/extremes/pictures.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

scene::Material glass(float ior, float roughness) {
  scene::Material m;
  m.metallic = 0.0f;
  m.roughness = roughness;
  m.ior = ior;
  m.transmission = 1.0f;
  m.thickness = 1.0f;
  return m;
}

TEST(Glass, ABallThatAbsorbsNothingIsInvisibleInAWhiteSky) {
  double worst = 0.0;
  int tried = 0;
  for (const float ior : {1.0f, 1.0001f, 1.019f, 1.5f, 3.0f}) {
    for (const float roughness : {0.0f, 1e-4f, 0.0299f, 0.03f, 0.05f}) {
      SceneBuilder builder;
      builder.sphere(builder.material(glass(ior, roughness)), Vec3::Zero(), 1.0f, 48, true);
      // Each path that leaves carries 1, whatever its length; 0.1 % are still inside after 200 events.
      const Rendered picture = render(builder.scene(), white_sky(24, 200));
      EXPECT_TRUE(picture.sane());
      const double error = std::abs(picture.mean() - 1.0);
      EXPECT_LT(error, 0.02) << ior << " " << roughness;
      worst = std::max(worst, error);
      ++tried;
    }
  }
  report_extreme("glass ball in a white sky", "ior 1 to 3, roughness 0, 1e-4, 0.03 (delta and not), 0.05",
                 fmt::format("{} balls, mean off by {:.1e} (bound 0.02)", tried, worst), "");
}

TEST(Glass, SmoothMirrorsReflectAllLight) {
  double worst = 0.0;
  for (const float roughness : {0.0f, 1e-4f, 0.0299f, 0.03f}) {
    SceneBuilder builder;
    scene::Material m;
    m.metallic = 1.0f;
    m.roughness = roughness;
    builder.sphere(builder.material(m), Vec3::Zero(), 1.0f, 48, true);
    const Rendered picture = render(builder.scene(), white_sky(16, 8));
    EXPECT_TRUE(picture.sane());
    worst = std::max(worst, std::abs(picture.mean() - 1.0));
  }
  EXPECT_LT(worst, 1e-3);
  report_extreme("metal ball in a white sky",
                 "roughness 0, 1e-4 and about 0.03, where the lobe stops being a delta",
                 fmt::format("mean off by {:.1e} (bound 1e-3)", worst), "");
}

/// Sheets of glass in a row, or each nested in the previous one.
Rendered sheets(float ior, int layers, bool nested) {
  SceneBuilder builder;
  const int m = builder.material(glass(ior, 0.0f));
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

TEST(Glass, HundredsOfSheetsLoseNoLight) {
  double worst = 0.0;
  for (const float ior : {1.0f, 1.5f, 3.0f}) {
    const Rendered picture = sheets(ior, 300, false);
    EXPECT_TRUE(picture.sane());
    EXPECT_LT(worst_pixel(picture), 0.01) << ior << " mean " << picture.mean();
    worst = std::max(worst, worst_pixel(picture));
  }
  report_extreme("sheets of glass in a row", "300, each with a volume, ior 1, 1.5 and 3, in a white sky",
                 fmt::format("every path carries 1 to within {:.1e} (bound 0.01)", worst), "");
}

TEST(Glass, NestedSheetsLoseNoLight) {
  double worst = 0.0;
  for (const float ior : {1.0f, 1.5f, 3.0f}) {
    for (const int layers : {1, 16, 300}) {
      const Rendered picture = sheets(ior, layers, true);
      EXPECT_TRUE(picture.sane());
      EXPECT_LT(worst_pixel(picture), 0.01) << ior << " " << layers << " mean " << picture.mean();
      worst = std::max(worst, worst_pixel(picture));
    }
  }
  report_extreme("nested sheets of glass", "1 to 300, ior 1, 1.5 and 3, in a white sky",
                 fmt::format("every path carries 1 to within {:.1e} (bound 0.01)", worst), "");
}

TEST(Glass, NestedBallsAddNoLight) {
  double air = 0.0, brightest = 0.0;
  for (const float ior : {1.0f, 1.5f, 3.0f}) {
    SceneBuilder builder;
    const int m = builder.material(glass(ior, 0.0f));
    for (int i = 0; i < 300; ++i) {
      builder.sphere(m, Vec3::Zero(), 1.0f - static_cast<float>(i) / 300.0f, 48, i % 2 == 0);
    }
    RenderOptions options = white_sky(4, 1000);
    options.min_depth = 1000;
    const Rendered picture = render(builder.scene(), options);
    EXPECT_TRUE(picture.sane());
    if (ior == 1.0f) air = worst_pixel(picture);
    for (const float v : picture.values) brightest = std::max(brightest, static_cast<double>(v));
  }
  EXPECT_LT(air, 1e-5);
  EXPECT_LT(brightest, 1.01);
  report_extreme(
      "nested balls of glass, as one object", "300, smooth and faceted, ior 1, 1.5 and 3, in a white sky",
      fmt::format("ior 1: invisible to {:.1e} (bound 1e-5); else finite, no pixel above {:.3f} (bound 1.01)",
                  air, brightest),
      "shells of one object are no media of their own: each refracts as from air, so that deep inside light "
      "is "
      "reflected totally and ends at the depth limit of 1000");
}

/// Mean radiance of a wall that a lamp or a sun lights through a stack of panes.
double light_behind_panes(int panes, float ior, bool sun, DirectLight direct) {
  SceneBuilder builder;
  scene::Material pane = glass(ior, 0.0f);
  pane.thickness = 0.0f;
  pane.specular = 0.0f;  // else Schlick's curve reflects at grazing angles whatever the index
  const int p = builder.material(pane);
  for (int i = 0; i < panes; ++i) {
    builder.quad(p, Vec3(-50, -50, 0.01f * static_cast<float>(i + 1)), Vec3(100, 0, 0), Vec3(0, 100, 0));
  }
  const int wall = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.quad(wall, Vec3(-1, -1, 0), Vec3(2, 0, 0), Vec3(0, 2, 0));
  if (sun) {
    scene::PunctualLight light;
    light.type = scene::LightType::directional;
    light.direction = Vec3(0, 0, -1);
    builder.scene().lights.push_back(light);
  } else {
    const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Ones()));
    builder.quad(lamp, Vec3(-40, 40, 20), Vec3(80, 0, 0), Vec3(0, -80, 0));
  }
  RenderOptions options = white_sky(16, 1);
  options.environment.constant.setZero();
  options.direct = direct;
  options.camera.look_at = LookAt{{0, 0, 0.005f}, {0, 0.002f, 0}, {0, 1, 0}};
  const Rendered picture = render(builder.scene(), options);
  EXPECT_TRUE(picture.sane());
  return picture.mean();
}

TEST(Glass, PanesOfIndexOneDoNotDarkenLamps) {
  double worst = 0.0;
  const double lamp = light_behind_panes(0, 1.0f, false, DirectLight::bsdf);
  const double sun = light_behind_panes(0, 1.0f, true, DirectLight::mis);
  for (const int panes : {1, 8, 64, 65, 200}) {
    for (const DirectLight direct : {DirectLight::mis, DirectLight::bsdf}) {
      const double error = std::abs(light_behind_panes(panes, 1.0f, false, direct) / lamp - 1.0);
      EXPECT_LT(error, 0.03) << panes;
      worst = std::max(worst, error);
    }
    const double error = std::abs(light_behind_panes(panes, 1.0f, true, DirectLight::mis) / sun - 1.0);
    if (panes <= 64) {
      EXPECT_LT(error, 1e-5);
    }
  }
  report_extreme("thin panes in a row", "1 to 200 of ior 1 between a wall and a lamp",
                 fmt::format("lamp's light off by {:.1e} (bound 0.03); a sun exact behind up to 64", worst),
                 "a sun, point or spot light behind more than 64 panes counts as dark");
}

}  // namespace
}  // namespace gatelight::renderer
