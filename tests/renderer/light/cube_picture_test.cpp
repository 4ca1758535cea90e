#include "renderer/light/cube_picture.h"

#include <gtest/gtest.h>

#include "renderer/image/srgb.h"
#include "renderer/light/environment.h"

namespace gatelight::renderer {
namespace {

/// Faces of one colour of their own: red is the axis, green its sign.
scene::ImageBasedLight six_colors(int size = 8) {
  scene::ImageBasedLight light;
  for (std::size_t f = 0; f < 6; ++f) {
    scene::Image& face = light.faces[f];
    face = {"", size, size, 3, {}};
    for (int i = 0; i < size * size; ++i) {
      face.pixels.push_back(static_cast<std::uint8_t>(100 + 50 * (f / 2)));
      face.pixels.push_back(f % 2 == 0 ? 200 : 50);
      face.pixels.push_back(0);
    }
  }
  return light;
}

Color linear(int r, int g, int b) {
  return {kSrgbToLinear[static_cast<std::size_t>(r)], kSrgbToLinear[static_cast<std::size_t>(g)],
          kSrgbToLinear[static_cast<std::size_t>(b)]};
}

TEST(CubePicture, FacesLieAlongTheirAxes) {
  const EnvironmentPicture picture = make_cube_picture(six_colors(), 2.0f);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) {
      Vec3 d = Vec3::Zero();
      d[axis] = sign;
      const Color expected = 2.0f * linear(100 + 50 * axis, sign > 0.0f ? 200 : 50, 0);
      EXPECT_TRUE(picture.radiance(d).isApprox(expected, 1e-4f)) << d.transpose();
    }
  }
}

TEST(CubePicture, FacesAreThoseThatAViewerInsideSees) {
  // The right half of each face is bright in blue, the upper half in red.
  constexpr int kSize = 16;
  scene::ImageBasedLight light = six_colors(kSize);
  for (scene::Image& face : light.faces) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        std::uint8_t* const p = &face.pixels[3 * static_cast<std::size_t>(y * kSize + x)];
        p[0] = y < kSize / 2 ? 255 : 0;
        p[1] = 0;
        p[2] = x < kSize / 2 ? 0 : 255;
      }
    }
  }
  const EnvironmentPicture picture = make_cube_picture(light, 1.0f);
  struct View {
    Vec3 forward, up;
  };
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  for (const View& view : {View{x, y}, View{-x, y}, View{y, -z}, View{-y, z}, View{z, y}, View{-z, y}}) {
    const Vec3 right = view.forward.cross(view.up);
    const auto at = [&](float to_right, float upwards) {
      return picture.radiance((view.forward + to_right * right + upwards * view.up).normalized());
    };
    EXPECT_NEAR(at(0.5f, 0.5f).z(), 1.0f, 1e-3f) << view.forward.transpose();
    EXPECT_NEAR(at(-0.5f, 0.5f).z(), 0.0f, 1e-3f) << view.forward.transpose();
    EXPECT_NEAR(at(0.5f, 0.5f).x(), 1.0f, 1e-3f) << view.forward.transpose();
    EXPECT_NEAR(at(0.5f, -0.5f).x(), 0.0f, 1e-3f) << view.forward.transpose();
  }
}

TEST(CubePicture, RotationTurnsTheCubeInTheWorld) {
  scene::ImageBasedLight light = six_colors();
  // A quarter turn about y takes +z to +x.
  light.rotation = Eigen::AngleAxisf(0.5f * kPi, Vec3::UnitY()).toRotationMatrix();
  const EnvironmentPicture picture = make_cube_picture(light, 1.0f);
  EXPECT_TRUE(picture.radiance(Vec3::UnitX()).isApprox(linear(200, 200, 0), 1e-4f));
  EXPECT_TRUE(picture.radiance(Vec3::UnitY()).isApprox(linear(150, 200, 0), 1e-4f));
}

TEST(CubePicture, AnAlphaDividesLinearColours) {
  scene::ImageBasedLight light;
  light.intensity = 3.0f;
  for (scene::Image& face : light.faces) face = {"", 1, 1, 4, {188, 188, 0, 51}};
  const Color found = make_cube_picture(light, 1.0f).radiance(Vec3::UnitX());
  EXPECT_TRUE(found.isApprox(15.0f * linear(188, 188, 0), 1e-4f)) << "five times, and three";
}

TEST(CubePicture, AFaceOfTheSunHasItsSolidAngle) {
  scene::ImageBasedLight light = six_colors();
  for (std::size_t f = 0; f < 6; ++f)
    std::fill(light.faces[f].pixels.begin(), light.faces[f].pixels.end(), f == 3 ? 255 : 0);
  // A sixth of the sphere, but for the seams.
  EXPECT_NEAR(make_cube_picture(light, 1.0f).mean().x(), 1.0f / 6.0f, 0.01f);
}

TEST(CubePicture, IsTheAutomaticEnvironmentOfItsScene) {
  const scene::ImageBasedLight light = six_colors();
  EnvironmentOptions options;
  options.automatic = true;
  options.scale = 0.5f;
  const Environment environment(options, &light);
  EXPECT_TRUE(environment.radiance(-Vec3::UnitZ()).isApprox(0.5f * linear(200, 50, 0), 1e-4f));
  options.automatic = false;
  options.constant = Color(1, 2, 3);
  EXPECT_TRUE(Environment(options, &light).radiance(Vec3::UnitX()).isApprox(Color(0.5f, 1.0f, 1.5f)))
      << "unless another one is named";
}

}  // namespace
}  // namespace gatelight::renderer
