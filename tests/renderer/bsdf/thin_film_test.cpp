#include "renderer/bsdf/thin_film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/bsdf/fresnel.h"
#include "renderer/sampling/color_matching.h"

namespace gatelight::renderer {
namespace {

/// Airy's reflectance of a film at normal incidence, as the eye sees it.
Eigen::Array3d airy_color(double film, double base, double thickness) {
  const double r12 = (1.0 - film) / (1.0 + film), r23 = (film - base) / (film + base);
  const auto reflectance = [&](double nm) {
    const double c = std::cos(4.0 * M_PI * film * thickness / nm);
    return (r12 * r12 + r23 * r23 + 2.0 * r12 * r23 * c) /
           (1.0 + r12 * r12 * r23 * r23 + 2.0 * r12 * r23 * c);
  };
  // The mean over all phases; differences from it have a colour.
  const double rr = r12 * r12 * r23 * r23;
  const double mean = r12 * r12 + (1.0 - r12 * r12) * (1.0 - r12 * r12) * r23 * r23 / (1.0 - rr);
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  double luminance = 0.0;
  for (double nm = 360.0; nm < 830.0; nm += 0.5) {
    xyz += color_matching(nm) * (reflectance(nm) - mean);
    luminance += color_matching(nm).y();
  }
  return mean + (rec709_from_xyz() * xyz / luminance).array();
}

TEST(ThinFilm, AtNormalIncidenceHasTheColoursOfAirysFormula) {
  for (const float film_ior : {1.2f, 1.38f, 1.8f}) {
    for (const float thickness : {120.0f, 250.0f, 400.0f, 600.0f, 900.0f}) {
      const ThinFilm film{1.0f, film_ior, thickness};
      const float base = 1.6f;
      const Color found = film.reflectance(1.0f, Color::Constant(dielectric_f0(base)));
      const Eigen::Array3d expected = airy_color(film_ior, base, thickness).max(0.0);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 0.02) << film_ior << ", " << thickness << ", channel " << c;
    }
  }
}

TEST(ThinFilm, AQuarterWaveOfTheRightIndexRemovesTheReflection) {
  // The film's index is the root of the base's, its thickness a quarter of 550 nm within it.
  const float base = 1.9f, index = std::sqrt(base);
  const float without = dielectric_f0(base);
  const ThinFilm film{1.0f, index, 550.0f / (4.0f * index)};
  EXPECT_LT(film.reflectance(1.0f, Color::Constant(without)).y(), 0.1f * without);
}

TEST(ThinFilm, WithoutThicknessOrWeightChangesNothing) {
  for (const float cosine : {1.0f, 0.5f, 0.1f}) {
    const Color base(0.04f, 0.3f, 0.9f);
    EXPECT_TRUE((ThinFilm{1.0f, 1.5f, 0.0f}.change(cosine, base, 1.0f) == 0.0f).all());
    EXPECT_TRUE((ThinFilm{0.0f, 1.5f, 400.0f}.change(cosine, base, 1.0f) == 0.0f).all());
  }
}

TEST(ThinFilm, ReflectanceIsBetweenZeroAndOne) {
  for (float cosine = 0.0f; cosine <= 1.0f; cosine += 0.05f) {
    for (const float thickness : {0.0f, 50.0f, 333.0f, 1000.0f, 1e6f}) {
      for (const float ior : {1.0f, 1.3f, 2.5f}) {
        for (const float f0 : {0.0f, 0.04f, 0.5f, 1.0f}) {
          for (const float outside : {1.0f, 1.5f}) {
            const Color r = ThinFilm{1.0f, ior, thickness, outside}.reflectance(cosine, Color::Constant(f0));
            EXPECT_TRUE(r.allFinite() && (r >= 0.0f).all() && (r <= 1.0f).all())
                << cosine << ", " << thickness << ", " << ior << ", " << f0;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
