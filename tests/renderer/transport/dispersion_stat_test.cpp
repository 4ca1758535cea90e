// A lamp seen through a prism.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "renderer/render.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {
using testing::SceneBuilder;

constexpr float kApex = 30.0f * kPi / 180.0f;
constexpr float kIor = 1.5f;

/// The row of the centroid of a strip of white light, in each channel. The camera looks along +x through a
/// prism whose edge is up.
std::array<double, 3> rows_of_the_strip(float dispersion) {
  SceneBuilder builder;
  scene::Material glass;
  glass.metallic = glass.roughness = 0.0f;
  glass.transmission = glass.thickness = 1.0f;
  glass.ior = kIor;
  glass.dispersion = dispersion;
  constexpr float kHeight = 2.0f;
  const float half = 2.0f * kHeight * std::tan(0.5f * kApex);
  PaddedVector<Vec3> corners;
  for (const float z : {kHeight, -kHeight}) {
    for (const Vec3& corner : {Vec3(-half, -kHeight, z), Vec3(half, -kHeight, z), Vec3(0, kHeight, z)})
      corners.push_back(corner);
  }
  builder.mesh(builder.material(glass), corners,
               {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}});
  scene::Material lamp;
  lamp.base_color.setZero();
  lamp.emission.setConstant(1.0f);
  lamp.double_sided = true;
  // The prism turns a ray along +x by nearly (n - 1) times the angle of its edge.
  const float down = 20.0f * std::tan(15.6f * kPi / 180.0f);
  builder.quad(builder.material(lamp), Vec3(20.0f, -down - 0.15f, -4.0f), Vec3(0, 0.3f, 0), Vec3(0, 0, 8.0f));

  RenderOptions options;
  options.width = 8;
  options.height = 96;
  options.spp = 256;
  options.camera.look_at = LookAt{.eye = Vec3(-6, 0, 0), .target = Vec3::Zero()};
  options.camera.fov_degrees = 10.0f;
  const Picture picture = Renderer(builder.scene(), options).render();
  const std::vector<float>& values = picture.layers[0].values;
  std::array<double, 3> sums{}, weighted{};
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double value =
            static_cast<double>(values[3 * static_cast<std::size_t>(y * options.width + x) + c]);
        sums[c] += value;
        weighted[c] += value * y;
      }
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(sums[c], 1.0) << "the strip is in the picture";
    weighted[c] /= sums[c];
  }
  // White light, whatever its colours do.
  for (std::size_t c = 1; c < 3; ++c) EXPECT_NEAR(sums[c] / sums[0], 1.0, 0.05);
  return weighted;
}

TEST(Dispersion, APrismTurnsBlueMoreThanGreenAndGreenMoreThanRed) {
  const std::array<double, 3> white = rows_of_the_strip(0.0f);
  EXPECT_NEAR(white[0], white[2], 0.02);
  const std::array<double, 3> spread = rows_of_the_strip(2.0f);
  // The angle between the wavelengths of the Abbe number, 486 and 656 nm, is that of n_F - n_C = 0.05: 14
  // rows of 96 in 10 degrees. The channels are broader, and nearer to each other.
  EXPECT_GT(spread[0] - spread[2], 5.0);
  EXPECT_LT(spread[0] - spread[2], 16.0);
  EXPECT_GT(spread[0], spread[1]);
  EXPECT_GT(spread[1], spread[2]);
}

}  // namespace
}  // namespace gatelight::renderer
