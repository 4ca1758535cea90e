#include "renderer/sampling/wavelength.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {
namespace {

TEST(Wavelengths, StayWhiteOnAverage) {
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  constexpr int kWavelengths = 1 << 16;
  float before = 390.0f;
  for (int i = 0; i < kWavelengths; ++i) {
    const Wavelength w = sample_wavelength((static_cast<float>(i) + 0.5f) / kWavelengths);
    EXPECT_GE(w.nm, before) << i;
    EXPECT_LE(w.nm, 710.0f);
    EXPECT_TRUE((w.color >= 0.0f).all());
    EXPECT_NEAR(w.color.sum(), 3.0f, 1e-4f);
    before = w.nm;
    mean += w.color.cast<double>() / kWavelengths;
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], 1.0, 2e-4);
}

TEST(Wavelengths, TheIndexIsThatOfTheAbbeNumber) {
  // Crown glass: V = (n_d - 1) / (n_F - n_C).
  const float n = 1.52f, abbe = 59.0f, dispersion = 20.0f / abbe;
  EXPECT_NEAR(dispersed_ior(n, dispersion, 587.6f), n, 1e-5f);
  const float spread = dispersed_ior(n, dispersion, 486.1f) - dispersed_ior(n, dispersion, 656.3f);
  EXPECT_NEAR((n - 1.0f) / spread, abbe, 0.05f);
  EXPECT_EQ(dispersed_ior(n, 0.0f, 450.0f), n);
  EXPECT_EQ(dispersed_ior(1.2f, 100.0f, 700.0f), 1.0f) << "never below one";
}

}  // namespace
}  // namespace gatelight::renderer
