// Scenes of any size, and far from the origin.

#include <gtest/gtest.h>

#include "base/errors.h"
#include "renderer/film/camera_choice.h"
#include "tests/extremes/pictures.h"
#include "tests/support/room.h"

namespace gatelight::renderer {
namespace {

using namespace testing;

Rendered at_scale(RenderOptions options, float scale) {
  scene::Scene s = room();
  resize(s, scale);
  resize(options, scale);
  return render(s, options);
}

TEST(Scale, PowersOfTwoGiveTheSameBitsAndTraining) {
  for (const Integrator integrator : kAll) {
    const RenderOptions options = room_picture(integrator, 24);
    const Rendered one = at_scale(options, 1.0f);
    for (const int exponent : {-20, -10, 10, 20}) {
      const Rendered other = at_scale(options, std::ldexp(1.0f, exponent));
      EXPECT_TRUE(one.values == other.values) << enum_name(integrator) << " 2^" << exponent;
      EXPECT_EQ(one.statistics.cache.loss, other.statistics.cache.loss);
      EXPECT_EQ(one.statistics.cache.resolution_histogram, other.statistics.cache.resolution_histogram);
    }
  }
}

TEST(Scale, AnyScaleGivesTheSamePictureAndTraining) {
  for (const Integrator integrator : kAll) {
    const RenderOptions options = room_picture(integrator, 24);
    const Rendered one = at_scale(options, 1.0f);
    RenderOptions again = options;
    again.seed = 1;
    const double noise = block_error(one, at_scale(again, 1.0f), options.width);
    for (const float scale : {1e-6f, 1e-3f, 1e3f, 1e6f, 1e8f}) {
      const Rendered other = at_scale(options, scale);
      EXPECT_LT(block_error(one, other, options.width), 0.01 * noise) << enum_name(integrator) << scale;
      if (!uses_cache(integrator)) continue;
      EXPECT_EQ(one.statistics.cache.resolution_histogram, other.statistics.cache.resolution_histogram);
      EXPECT_NEAR(other.statistics.cache.loss / one.statistics.cache.loss, 1.0, 0.01);
    }
    const Rendered tiny = at_scale(options, std::ldexp(1.0f, -30));
    EXPECT_LT(block_error(one, tiny, options.width), 4.0 * noise);
  }
}

/// The room with a camera of its own.
scene::Scene room_with_camera() {
  scene::Scene s = room();
  s.cameras.push_back(choose_camera(s, room_picture(Integrator::path, 16).camera, 4.0f / 3.0f));
  return s;
}

Rendered with_its_own_camera(const scene::Scene& s, std::uint32_t seed = 0) {
  RenderOptions options = room_picture(Integrator::path, 16);
  options.camera.look_at.reset();
  options.seed = seed;
  return render(s, options);
}

/// Only the reader of files moves a scene back to the origin: here single precision is the limit.
TEST(Moved, ASceneMadeInCodeKeepsThePrecisionOfItsCoordinates) {
  constexpr double kSize = 5.0;  // of the room, in metres
  const int width = room_picture(Integrator::path, 16).width;
  const Rendered here = with_its_own_camera(room_with_camera());
  const double noise = block_error(here, with_its_own_camera(room_with_camera(), 1), width);
  for (const double sizes : {1e2, 1e3, 1e4, 1e6}) {
    scene::Scene s = room_with_camera();
    const auto d = static_cast<float>(sizes * kSize / std::sqrt(3.0));
    resize(s, 1.0f, Vec3(d, -d, d));
    const Rendered far = with_its_own_camera(s);
    if (sizes <= 1e4) {
      EXPECT_LT(block_error(here, far, width), noise) << sizes;
    }
  }
}

/// A white wall that fills the middle of the picture, half its width and height.
Rendered wall_seen_from(double distance) {
  constexpr int kPixels = 64;
  const double side = std::min(distance, 1e9);
  const auto h = static_cast<float>(0.5 * side);
  SceneBuilder builder;
  const int white = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Ones()));
  builder.quad(white, Vec3(-h, -h, 0), Vec3(2 * h, 0, 0), Vec3(0, 2 * h, 0));
  RenderOptions options;
  options.width = options.height = kPixels;
  options.spp = 4;
  options.filter = PixelFilter::box;
  options.camera.look_at = LookAt{{0, 0, static_cast<float>(distance)}, {0, 0, 0}, {0, 1, 0}};
  options.camera.fov_degrees = static_cast<float>(2.0 * std::atan(side / distance) * 180.0 / M_PI);
  return render(builder.scene(), options);
}

TEST(Moved, AFarCameraSeesAWallAtTheRightPixels) {
  constexpr int kPixels = 64;
  for (const double distance : {1e-3, 1.0, 1e3, 1e6, 1e9, 1e11, 1e12}) {
    const Rendered picture = wall_seen_from(distance);
    // Pixels on its border, and one on either side, may be either.
    const auto within = [](int i, int margin) {
      return i >= kPixels / 4 - margin && i < 3 * kPixels / 4 + margin;
    };
    for (int y = 0; y < kPixels; ++y) {
      for (int x = 0; x < kPixels; ++x) {
        const float value = picture.values[static_cast<std::size_t>(3 * (y * kPixels + x))];
        if (within(x, -1) && within(y, -1)) {
          ASSERT_EQ(value, 1.0f) << distance << " m: " << x << ", " << y;
        } else if (!within(x, 1) || !within(y, 1)) {
          ASSERT_EQ(value, 0.0f) << distance << " m: " << x << ", " << y;
        }
      }
    }
  }
  EXPECT_THROW(wall_seen_from(1.1e12), BadOption);
}

}  // namespace
}  // namespace gatelight::renderer
