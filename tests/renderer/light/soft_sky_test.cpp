// The light of scenes without light.

#include "renderer/light/soft_sky.h"

#include <gtest/gtest.h>

#include "renderer/light/environment.h"

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
    constexpr int kTheta = 64, kPhi = 128;
    for (int i = 0; i < kTheta; ++i) {
      for (int j = 0; j < kPhi; ++j) {
        const float theta = kPi * (static_cast<float>(i) + 0.5f) / kTheta;
        const float phi = 2.0f * kPi * (static_cast<float>(j) + 0.5f) / kPhi;
        const Vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        const float solid_angle = std::sin(theta) * (kPi / kTheta) * (2.0f * kPi / kPhi);
        reflected += sky.radiance(d) * (std::max(0.0f, n.dot(d)) * solid_angle / kPi);
        ASSERT_TRUE(twice.radiance(d).isApprox(2.0f * sky.radiance(d), 1e-5f));
      }
    }
    EXPECT_GT(reflected.minCoeff(), 0.2f) << n.transpose();
    EXPECT_LT(reflected.maxCoeff(), 1.2f) << n.transpose();
  }
}

}  // namespace
}  // namespace gatelight::renderer
