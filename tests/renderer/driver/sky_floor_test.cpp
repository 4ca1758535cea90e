// Whole pictures below a clear sky.

#include <gtest/gtest.h>

#include "renderer/light/clear_sky.h"
#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {

namespace {

using testing::SceneBuilder;

/// The mean of a picture that a level matte floor fills.
Color floor_below(const SkyOptions& sky, float albedo, const RenderOptions& given) {
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color::Constant(albedo)), 5);
  RenderOptions options = given;
  options.width = options.height = 32;
  options.camera.look_at = LookAt{Vec3(0, 3, 0.5f), Vec3(0, 0, 0), Vec3(0, 1, 0)};
  options.environment.sky = sky;
  const Picture picture = Renderer(builder.scene(), options).render();
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  const std::vector<float>& values = picture.layers[0].values;
  for (std::size_t i = 0; i < values.size(); ++i)
    sum[static_cast<Eigen::Index>(i % 3)] += static_cast<double>(values[i]);
  return (sum * (3.0 / static_cast<double>(values.size()))).cast<float>();
}

// The sky below the horizon is such a floor, computed without a path tracer.
TEST(SkyFloor, IsAsBrightAsTheGroundOfTheSky) {
  for (const float elevation : {50.0f, 6.0f}) {
    for (const float size : {0.0f, 0.53f, 5.0f}) {
      const SkyOptions sky{
          .sun_elevation_degrees = elevation, .time = {}, .ground = 0.4f, .sun_size_degrees = size};
      const Color ground = make_clear_sky(sky, 1.0f).picture.radiance(Vec3(0, -1, 0));
      RenderOptions options;
      options.spp = 64;
      const Color floor = floor_below(sky, 0.4f, options);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(floor[c], ground[c], 0.01f * ground[c]) << elevation << " " << size;
    }
  }
}

TEST(SkyFloor, LightSamplesAndBouncesFindTheSameSun) {
  // A disc of 20 degrees, which bounces without light samples find often enough.
  const SkyOptions sky{.sun_elevation_degrees = 40.0f, .time = {}, .sun_size_degrees = 20.0f};
  RenderOptions options;
  options.spp = 256;
  const Color mis = floor_below(sky, 0.5f, options);
  for (const DirectLight direct : {DirectLight::nee, DirectLight::bsdf}) {
    options.direct = direct;
    const Color one = floor_below(sky, 0.5f, options);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(one[c], mis[c], 0.02f * mis[c]) << static_cast<int>(direct);
  }
}

}  // namespace
}  // namespace gatelight::renderer
