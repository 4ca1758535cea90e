// Objects that the camera sees as holes.

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/render.h"
#include "tests/renderer/cache/cached_pictures.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

/// A wall of radiance 1, whose left half is behind a holdout of radiance 2. Three by three pixels, and the
/// holdout ends in the middle of those in the middle.
struct HalfHidden : SceneBuilder {
  RenderOptions options;

  HalfHidden() {
    quad(material(lambert(Color::Zero(), Color::Ones())), Vec3(-50, -50, -5), Vec3(100, 0, 0),
         Vec3(0, 100, 0));
    quad(material(lambert(Color::Zero(), Color::Constant(2.0f))), Vec3(-50, -50, -2), Vec3(50, 0, 0),
         Vec3(0, 100, 0));
    scene().instances.back().visibility.holdout = true;
    options.width = options.height = 3;
    options.spp = 4096;
    options.filter = PixelFilter::box;
    options.filter_width = 1.0f;
    options.background.kind = BackgroundOptions::Kind::transparent;
    options.camera.look_at = LookAt{Vec3(0, 0, 0), Vec3(0, 0, -1), Vec3(0, 1, 0)};
  }
  void expect_half() {
    const Picture picture = Renderer(scene(), options).render();
    const std::vector<float>& values = picture.layers[0].values;
    for (std::size_t y = 0; y < 3; ++y) {
      for (std::size_t x = 0; x < 3; ++x) {
        const float* pixel = &values[4 * (3 * y + x)];
        const float tolerance = x == 1 ? 5e-3f : 0.0f;
        EXPECT_NEAR(pixel[0], 0.5f * static_cast<float>(x), tolerance);
        EXPECT_NEAR(pixel[3], 0.5f * static_cast<float>(x), tolerance);
      }
    }
  }
};

TEST(Holdout, GivesAHalfCoveredPixelHalfTheColourAndAlpha) {
  HalfHidden half;
  half.expect_half();
}

TEST(Holdout, IsAHoleBehindAClearPaneToo) {
  HalfHidden half;
  scene::Material pane = SceneBuilder::clear_glass();
  pane.ior = 1.0f;
  half.quad(half.material(pane), Vec3(-9, -9, -1), Vec3(18, 0, 0), Vec3(0, 18, 0));
  half.expect_half();
}

TEST(Holdout, IsAHoleForCachedPaths) {
  HalfHidden half;
  half.options.integrator = Integrator::nrc;
  half.options.cache = cached_picture(Integrator::nrc).cache;
  half.options.cache.train_steps = 2;
  half.expect_half();
}

TEST(Holdout, IsBlackWithoutAnAlpha) {
  HalfHidden half;
  half.options.background.kind = BackgroundOptions::Kind::scene;
  half.options.environment.constant = Color::Ones();
  half.options.spp = 4;
  const Picture picture = Renderer(half.scene(), half.options).render();
  for (const std::size_t c : {0u, 1u, 2u}) EXPECT_EQ(picture.layers[0].values[c], 0.0f);
}

/// The value of a picture of one colour.
float one_colour(const SceneBuilder& builder, const LookAt& view) {
  SceneBuilder copy = builder;
  RenderOptions options;
  options.width = options.height = 4;
  options.spp = 16;
  options.camera.look_at = view;
  options.camera.fov_degrees = 1.0f;
  return Renderer(copy.scene(), options).render().layers[0].values[0];
}

TEST(Holdout, IsSeenByOtherRays) {
  const LookAt down{Vec3(0, 2, 0), Vec3(0, 0, 0), Vec3(0, 0, -1)};
  const auto with = [](const scene::Material& seen, float height) {
    SceneBuilder builder;
    builder.box(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(2.0f))),
                Vec3(-9, height, -9), Vec3(9, height + 1.0f, 9));
    builder.scene().instances.back().visibility.holdout = true;
    testing::add_floor(builder, seen, 5);
    return builder;
  };
  EXPECT_NEAR(one_colour(with(testing::mirror(), 4), down), 2.0f * 0.9f, 1e-4f);
  // A body of glass is more than a pane: behind it are the light and the shape of the object.
  SceneBuilder behind = with(SceneBuilder::lambert(Color::Zero()), -3);
  behind.scene().instances.pop_back();
  behind.box(behind.material(testing::solid_glass(1.0f)), Vec3(-1, -1, -1), Vec3(1, 1, 1));
  EXPECT_NEAR(one_colour(behind, down), 2.0f, 1e-4f);
}

TEST(Holdout, CastsItsShadow) {
  const LookAt down{Vec3(0, 2, 0), Vec3(0, 0, 0), Vec3(0, 0, -1)};
  for (const float height : {3.0f, -9.0f}) {
    SceneBuilder builder;
    builder.box(builder.material(SceneBuilder::lambert(Color::Ones())), Vec3(-9, height, -9),
                Vec3(9, height + 1.0f, 9));
    builder.scene().instances.back().visibility.holdout = true;
    testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(0.5f)), 5);
    builder.scene().lights = {testing::sun(Vec3(0, -1, 0))};
    EXPECT_NEAR(one_colour(builder, down), height > 0.0f ? 0.0f : 0.5f * kInvPi, 1e-4f);
  }
}

}  // namespace
}  // namespace gatelight::renderer
