// The light of scenes without light.

#include "renderer/light/soft_sky.h"

#include <gtest/gtest.h>

#include "renderer/light/environment.h"
#include "tests/support/sphere_integral.h"

namespace gatelight::renderer {
namespace {

TEST(SoftSky, MakesWhiteSurfacesNeitherDarkNorOverexposed) {
  EnvironmentOptions options;
  options.automatic = true;
  const Environment sky(options);
  options.scale = 2.0f;
  const Environment twice(options);
  for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(1, 0, 0)}) {
    Color reflected = Color::Zero();
    testing::each_direction(64, [&](const Vec3& d, double solid_angle) {
      const float share = static_cast<float>(solid_angle) / kPi;
      reflected += sky.radiance(d) * (std::max(0.0f, n.dot(d)) * share);
      EXPECT_TRUE(twice.radiance(d).isApprox(2.0f * sky.radiance(d), 1e-5f));
    });
    EXPECT_GT(reflected.minCoeff(), 0.2f) << n.transpose();
    EXPECT_LT(reflected.maxCoeff(), 1.2f) << n.transpose();
  }
}

}  // namespace
}  // namespace gatelight::renderer
