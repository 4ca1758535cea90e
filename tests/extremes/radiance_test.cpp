// Light without bounds: very weak, very strong, none.

#include <gtest/gtest.h>

#include <limits>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/extremes/pictures.h"
#include "tests/support/materials.h"
#include "tests/support/room.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

RenderOptions small(Integrator integrator, int spp) {
  RenderOptions options;
  options.width = 24;
  options.height = 16;
  options.integrator = integrator;
  options.spp = spp;
  options.cache.train_steps = 12;
  options.cache.batch = 512;
  return options;
}

/// A closed box of one matte material that emits: every point has the radiance emission / (1 - albedo).
void add_furnace(SceneBuilder& builder, const Vec3& centre, float albedo, float emission) {
  const int m = builder.material(SceneBuilder::lambert(Color::Constant(albedo), Color::Constant(emission)));
  builder.box(m, centre - Vec3(1, 1, 1), centre + Vec3(1, 1, 1), true);
}

double worst_error(const Rendered& picture, double expected) {
  double worst = 0.0;
  for (const float v : picture.values)
    worst = std::max(worst, std::abs(static_cast<double>(v) / expected - 1.0));
  return worst;
}

TEST(Radiance, DimAndBrightRoomsOfOneSceneKeepTheirOwnRadiance) {
  const float emissions[] = {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f};
  SceneBuilder builder;
  for (int i = 0; i < 5; ++i)
    add_furnace(builder, Vec3(3.0f * static_cast<float>(i), 0, 0), 0.5f, emissions[i]);
  for (int i = 0; i < 5; ++i) {
    for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
      RenderOptions options = small(integrator, 128);
      options.max_depth = 40;
      const float x = 3.0f * static_cast<float>(i);
      options.camera.look_at = LookAt{{x, 0, 0.5f}, {x + 0.3f, 0.2f, -1}, {0, 1, 0}};
      const Rendered picture = render(builder.scene(), options);
      const double expected = 2.0 * static_cast<double>(emissions[i]);
      if (integrator == Integrator::path) {
        EXPECT_NEAR(picture.mean() / expected, 1.0, 0.02) << emissions[i];
      }
    }
  }
}

TEST(Radiance, ASunThroughAKeyholeLightsItsPatchAndNothingElse) {
  // A closed dark room of 4 m with a hole of 1 cm in its ceiling; the sun stands directly above.
  constexpr float kHole = 0.01f;
  constexpr float kSun = 1e8f;
  constexpr float kAlbedo = 0.5f;
  SceneBuilder builder;
  const int m = builder.material(SceneBuilder::lambert(Color::Constant(kAlbedo)));
  const float h = 0.5f * kHole;
  builder.quad(m, Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  for (const float s : {-1.0f, 1.0f}) {
    builder.quad(m, Vec3(-2, 0, 2 * s), Vec3(4, 0, 0), Vec3(0, 2, 0));
    builder.quad(m, Vec3(2 * s, 0, -2), Vec3(0, 0, 4), Vec3(0, 2, 0));
    builder.quad(m, Vec3(-2, 2, s > 0 ? h : -2), Vec3(4, 0, 0), Vec3(0, 0, 2 - h));
    builder.quad(m, Vec3(s > 0 ? h : -2, 2, -h), Vec3(2 - h, 0, 0), Vec3(0, 0, kHole));
  }
  builder.scene().lights.push_back(testing::sun(Vec3(0, -1, 0), Color::Constant(kSun)));
  RenderOptions options = small(Integrator::path, 64);
  options.filter = PixelFilter::box;
  options.width = options.height = 32;
  options.camera.look_at = LookAt{{0, 1.9f, 0.3f}, {0, 0, 0}, {0, 1, 0}};
  options.camera.fov_degrees = 1.2f;
  options.max_depth = 1;
  const Rendered direct = render(builder.scene(), options);
  const float peak = *std::max_element(direct.values.begin(), direct.values.end());
  const double expected = static_cast<double>(kAlbedo * kSun) / M_PI;
  EXPECT_NEAR(static_cast<double>(peak) / expected, 1.0, 1e-4);
  EXPECT_EQ(*std::min_element(direct.values.begin(), direct.values.end()), 0.0f);
  for (const Integrator integrator : kAll) {
    RenderOptions whole = small(integrator, 16);
    whole.camera.look_at = LookAt{{0, 1, 1.9f}, {0, 0.7f, 0}, {0, 1, 0}};
    render(builder.scene(), whole);
  }
}

TEST(Radiance, ASceneWithoutLightIsBlack) {
  for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
    scene::Scene s = room();
    for (scene::Material& m : s.materials) m.emission.setZero();
    RenderOptions options = small(integrator, 4);
    options.camera = small_picture().camera;
    const Rendered picture = render(s, options);
    const float brightest = *std::max_element(picture.values.begin(), picture.values.end());
    EXPECT_LE(brightest, integrator == Integrator::path ? 0.0f : 0.01f);
  }
}

TEST(Radiance, BlackMaterialsShowOnlyEmission) {
  for (const Integrator integrator : kAll) {
    scene::Scene s = room();
    for (scene::Material& m : s.materials) {
      m = SceneBuilder::lambert(Color::Zero(), m.emits() ? Color::Constant(10.0f) : Color(Color::Zero()));
    }
    RenderOptions options = small(integrator, 4);
    options.filter = PixelFilter::box;
    options.camera = small_picture().camera;
    const Rendered picture = render(s, options);
    if (integrator == Integrator::ao || integrator == Integrator::nao) continue;
    for (const float v : picture.values) {
      // A pixel has 4 samples, of which 0 to 4 hit the lamp.
      EXPECT_TRUE(v == 0.0f || v == 2.5f || v == 5.0f || v == 7.5f || v == 10.0f) << v;
    }
  }
}

TEST(Radiance, BlackEmittersShowTheirEmission) {
  for (const float emission : {1e-6f, 1.0f, 1e6f, 1e30f}) {
    SceneBuilder builder;
    add_furnace(builder, Vec3::Zero(), 0.0f, emission);
    for (const Integrator integrator : kAll) {
      RenderOptions options = small(integrator, 2);
      options.camera.look_at = LookAt{{0, 0, 0.5f}, {0.3f, 0.2f, -1}, {0, 1, 0}};
      const Rendered picture = render(builder.scene(), options);
      if (integrator == Integrator::path || integrator == Integrator::nrc) {
        EXPECT_LT(worst_error(picture, static_cast<double>(emission)), 1e-6) << emission;
      }
    }
  }
}

TEST(Radiance, LayersThatOverflowBecomeTheGreatestFloat) {
  const tests::TemporaryFolder folder;
  const std::string file = (folder / "a.exr").string();
  float greatest = 0.0f;
  for (const float emission : {1e10f, 1e19f, 1e30f}) {
    // Small lamps: only some samples of a pixel hit one.
    SceneBuilder builder;
    const int floor = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
    const int lamp = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(emission)));
    builder.box(floor, Vec3(-1, -1, -1), Vec3(1, 1, 1), true);
    for (float x = -0.9f; x < 0.9f; x += 0.3f) {
      for (float y = -0.9f; y < 0.9f; y += 0.3f)
        builder.quad(lamp, Vec3(x, y, -0.99f), Vec3(0.1f, 0, 0), Vec3(0, 0.1f, 0));
    }
    for (const Integrator integrator : {Integrator::path, Integrator::nrc}) {
      RenderOptions options = small(integrator, 8);
      options.camera.look_at = LookAt{{0, 0, 0.9f}, {0, 0, -1}, {0, 1, 0}};
      options.aovs = {Aov::variance};
      if (integrator == Integrator::nrc) {
        options.aovs.insert(options.aovs.end(), {Aov::cache_answer, Aov::cache_error});
      }
      Renderer renderer(builder.scene(), options);
      write_image(renderer.render(), file);
      const Picture read = read_image(file);
      ASSERT_EQ(read.layers.size(), options.aovs.size() + 1);
      for (const Layer& layer : read.layers) {
        for (const float v : layer.values) ASSERT_TRUE(std::isfinite(v)) << layer.name << " " << emission;
      }
      const std::vector<float>& variances = read.find("variance")->values;
      greatest = std::max(greatest, *std::max_element(variances.begin(), variances.end()));
    }
  }
  EXPECT_EQ(greatest, std::numeric_limits<float>::max());
}

TEST(Radiance, AWhiteFurnaceAddsItsEmissionAtEachScattering) {
  // Every scattering event adds the emission once more: (depth + 1) times it, with and without roulette.
  SceneBuilder builder;
  add_furnace(builder, Vec3::Zero(), 1.0f, 1.0f);
  for (const int depth : {0, 1, 10, 100, 1000}) {
    RenderOptions options = small(Integrator::path, depth > 100 ? 1 : 8);
    options.direct = DirectLight::bsdf;
    options.max_depth = depth;
    options.min_depth = depth + 1;
    options.camera.look_at = LookAt{{0, 0, 0.5f}, {0.3f, 0.2f, -1}, {0, 1, 0}};
    const Rendered picture = render(builder.scene(), options);
    EXPECT_LT(worst_error(picture, depth + 1.0), 1e-3) << depth;
  }
  RenderOptions options = small(Integrator::path, 64);
  options.max_depth = 30;
  options.camera.look_at = LookAt{{0, 0, 0.5f}, {0.3f, 0.2f, -1}, {0, 1, 0}};
  const Rendered roulette = render(builder.scene(), options);
  Moments pixels;
  for (std::size_t i = 0; i < roulette.values.size(); i += 3)
    pixels.add(static_cast<double>(roulette.values[i]));
  EXPECT_GT(mean_p_value(pixels, 31.0), 1e-4) << pixels.mean() << " +- " << pixels.standard_error();
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
    render(builder.scene(), small(integrator, 2));
  }
}

}  // namespace
}  // namespace gatelight::renderer
