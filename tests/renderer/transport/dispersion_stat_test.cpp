// A lamp seen through a prism.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {
using testing::Moments;
using testing::SceneBuilder;

constexpr float kApex = 30.0f * kPi / 180.0f;
constexpr float kIor = 1.5f;
// As many samples in all as one picture of 256 would have.
constexpr int kSamples = 8;
constexpr std::uint32_t kSeeds = 32;

void expect_mean(const Moments& moments, double expected) {
  EXPECT_GT(testing::mean_p_value(moments, expected, 1e-5), testing::sidak(1e-4, 5))
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

/// Sums and rows of the centroid of a strip of white light, in each channel.
struct Strip {
  std::array<double, 3> sums{}, rows{};
};

/// A strip seen along +x through a prism whose edge is up.
Strip strip(float dispersion, std::uint32_t seed) {
  SceneBuilder builder;
  scene::Material glass = testing::solid_glass(kIor);
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
  options.spp = kSamples;
  options.camera.look_at = LookAt{.eye = Vec3(-6, 0, 0), .target = Vec3::Zero()};
  options.camera.fov_degrees = 10.0f;
  options.seed = seed;
  const Picture picture = Renderer(builder.scene(), options).render();
  const std::vector<float>& values = picture.layers[0].values;
  Strip strip;
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double value =
            static_cast<double>(values[3 * static_cast<std::size_t>(y * options.width + x) + c]);
        strip.sums[c] += value;
        strip.rows[c] += value * y;
      }
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_GT(strip.sums[c], 1.0) << "the strip is in the picture";
    strip.rows[c] /= strip.sums[c];
  }
  return strip;
}

/// The strips of some seeds.
struct Strips {
  explicit Strips(float dispersion) {
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const Strip one = strip(dispersion, seed);
      green.add(one.sums[1] / one.sums[0]);
      blue.add(one.sums[2] / one.sums[0]);
      for (std::size_t c = 0; c < 3; ++c) rows[c].add(one.rows[c]);
      width.add(one.rows[0] - one.rows[2]);
    }
  }
  Moments green, blue;            ///< sums over that of red
  std::array<Moments, 3> rows{};  ///< rows of the centroids
  Moments width;                  ///< rows between red and blue
};

TEST(Dispersion, APrismTurnsBlueMoreThanGreenAndGreenMoreThanRed) {
  const Strips white(0.0f), spread(2.0f);
  // White light, whatever its colours do.
  for (const Strips* strips : {&white, &spread}) {
    expect_mean(strips->green, 1.0);
    expect_mean(strips->blue, 1.0);
  }
  expect_mean(white.width, 0.0);
  // The angle between the wavelengths of the Abbe number, 486 and 656 nm, is that of n_F - n_C = 0.05: 14
  // rows of 96 in 10 degrees. The channels are broader, and nearer to each other.
  EXPECT_GT(spread.width.mean(), 5.0);
  EXPECT_LT(spread.width.mean(), 16.0);
  EXPECT_GT(spread.rows[0].mean(), spread.rows[1].mean());
  EXPECT_GT(spread.rows[1].mean(), spread.rows[2].mean());
}

}  // namespace
}  // namespace gatelight::renderer
