// A surface split at a roughness: the parts add up to the whole, and no lobe is in both.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "renderer/sampling/warp.h"
#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/support/random_points.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;

// Only deltas, between the lobes of the cases, everything: then the narrow part is the whole.
constexpr std::array<float, 5> kThresholds{0.0f, 0.15f, 0.35f, 0.7f, 1.1f};
constexpr std::array<float, 4> kPartRoughnesses{0.0f, 0.1f, 0.3f, 0.8f};

/// A BSDF with a separate normal of the clearcoat, so that no two deltas coincide.
Bsdf tilted_bsdf(const BsdfCase& c, float roughness, const Vec3& wo) {
  SurfaceMaterial material = c.material;
  material.roughness = roughness;
  const Vec3 n = Vec3::UnitZ();
  return Bsdf(material, n, n, Vec3(0.1f, 0.2f, 1.0f).normalized(), wo, c.front);
}

template <class F>
void for_each_split(F&& check) {
  for (const BsdfCase& c : colored_cases()) {
    for (const float roughness : kPartRoughnesses) {
      for (const float cosine : {0.9f, 0.3f, 0.05f}) {
        const Bsdf whole = tilted_bsdf(c, roughness, incident(cosine));
        for (const float threshold : kThresholds) {
          SCOPED_TRACE(describe(c, roughness, cosine) + ", split at " + std::to_string(threshold));
          check(c, roughness, whole, threshold);
        }
      }
    }
  }
}

BsdfSample draw(const Bsdf& bsdf, Random& random) {
  const float u_lobe = random.uniform_float();
  return bsdf.sample(u_lobe, testing::next_2d(random));
}

bool is_black(const Bsdf& bsdf) {
  return (bsdf.albedo() == 0.0f).all() && !(bsdf.sample(0.5f, {0.5f, 0.5f}).pdf > 0.0f);
}

TEST(BsdfParts, ValuesAndAlbedosAddUpToTheWhole) {
  Random random(1);
  for_each_split([&](const BsdfCase&, float, const Bsdf& whole, float threshold) {
    const Bsdf wide = whole.wide_part(threshold);
    const Bsdf narrow = whole.narrow_part(threshold);
    for (int i = 0; i < 60; ++i) {
      // Half of the directions are where the lobes are.
      Vec3 wi = i % 2 == 0 ? draw(whole, random).wi : Vec3(Vec3::Zero());
      if (wi.isZero(0.0f)) {
        wi = sample_uniform_sphere(testing::next_2d(random));
      }
      const Color expected = whole.evaluate(wi).value;
      const Color sum = wide.evaluate(wi).value + narrow.evaluate(wi).value;
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(sum[k], expected[k], 1e-5f * expected[k]);
    }
    EXPECT_GE(wide.albedo().minCoeff(), 0.0f);
    EXPECT_GE(narrow.albedo().minCoeff(), 0.0f);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(wide.albedo()[k] + narrow.albedo()[k], whole.albedo()[k], 1e-6f);
  });
}

TEST(BsdfParts, DeltasAreThoseOfTheWholeAndOnlyInTheNarrowPart) {
  Random random(2);
  int found = 0;
  for_each_split([&](const BsdfCase&, float, const Bsdf& whole, float threshold) {
    std::vector<BsdfSample> deltas;
    for (int i = 0; i < 64; ++i) {
      const BsdfSample sample = draw(whole, random);
      if (sample.delta) deltas.push_back(sample);
    }
    const Bsdf wide = whole.wide_part(threshold);
    const Bsdf narrow = whole.narrow_part(threshold);
    EXPECT_TRUE(deltas.empty() || whole.has_narrow(threshold));
    for (int i = 0; i < 64; ++i) {
      ASSERT_FALSE(draw(wide, random).delta);
      const BsdfSample sample = draw(narrow, random);
      for (const BsdfSample& other : deltas) {
        if (!sample.delta || (other.wi - sample.wi).norm() > 1e-6f) continue;
        ++found;
        ASSERT_EQ(sample.transmitted, other.transmitted);
        ASSERT_EQ(sample.radiance_scale, other.radiance_scale);
        for (int k = 0; k < 3; ++k) {
          const float power = other.weight[k] * other.pdf;
          ASSERT_NEAR(sample.weight[k] * sample.pdf, power, 1e-5f * power);
        }
      }
    }
    EXPECT_TRUE((wide.unrefracted_transmittance() == 0.0f).all());
    EXPECT_TRUE((narrow.unrefracted_transmittance() == whole.unrefracted_transmittance()).all());
  });
  EXPECT_GT(found, 10000);
}

TEST(BsdfParts, WeightIsValueOverDensity) {
  Random random(3);
  int compared = 0;
  for_each_split([&](const BsdfCase&, float, const Bsdf& whole, float threshold) {
    for (const Bsdf& part : {whole.wide_part(threshold), whole.narrow_part(threshold)}) {
      for (int i = 0; i < 30; ++i) {
        const BsdfSample sample = draw(part, random);
        if (sample.delta || !(sample.pdf > 0.0f)) continue;
        const BsdfValue value = part.evaluate(sample.wi);
        ASSERT_NEAR(sample.wi.norm(), 1.0f, 1e-5f);
        ASSERT_FLOAT_EQ(value.pdf, sample.pdf);
        for (int k = 0; k < 3; ++k) ASSERT_FLOAT_EQ(value.value[k], sample.weight[k] * sample.pdf);
        ASSERT_EQ(sample.transmitted, sample.wi.z() < 0.0f);
        ASSERT_TRUE(!sample.transmitted || part.transmits());
        ++compared;
      }
    }
  });
  EXPECT_GT(compared, 10000);
}

TEST(BsdfParts, EachSamplesOnlyItsOwnLobes) {
  Random random(4);
  for_each_split([&](const BsdfCase& c, float roughness, const Bsdf& whole, float threshold) {
    const Bsdf wide = whole.wide_part(threshold);
    const Bsdf narrow = whole.narrow_part(threshold);
    const float alpha = std::min(threshold * threshold, 1.0f);
    // The light that rough glass scatters more than once goes with its microfacets, but is spread widely.
    const bool scatters = c.material.transmission > 0.0f && !c.material.thin_walled && roughness > 0.0f;
    for (int i = 0; i < 60; ++i) {
      const BsdfSample a = draw(wide, random);
      if (a.pdf > 0.0f) {
        ASSERT_FALSE(a.delta);
        ASSERT_GE(a.spread, alpha);
      }
      const BsdfSample b = draw(narrow, random);
      // An anisotropic lobe is as narrow as its narrow side.
      if (b.pdf > 0.0f && !scatters && c.material.anisotropy == 0.0f) {
        ASSERT_TRUE(b.delta || b.spread < alpha);
      }
    }
  });
}

TEST(BsdfParts, APartWithLobesScattersLightAndOneWithoutIsBlack) {
  for_each_split([&](const BsdfCase&, float, const Bsdf& whole, float threshold) {
    const Bsdf wide = whole.wide_part(threshold);
    const Bsdf narrow = whole.narrow_part(threshold);
    EXPECT_EQ(is_black(wide), !whole.has_wide(threshold));
    EXPECT_EQ(is_black(narrow), !whole.has_narrow(threshold));
    EXPECT_TRUE(whole.has_wide(threshold) || whole.has_narrow(threshold));
    // The parts of a part are itself and nothing.
    EXPECT_FALSE(wide.has_narrow(threshold) || narrow.has_wide(threshold));
    EXPECT_EQ(wide.has_wide(threshold), whole.has_wide(threshold));
    EXPECT_EQ(narrow.has_narrow(threshold), whole.has_narrow(threshold));
    EXPECT_TRUE(is_black(wide.narrow_part(threshold)) && is_black(narrow.wide_part(threshold)));
    EXPECT_EQ(wide.is_delta(), !whole.has_wide(threshold));
  });
}

TEST(BsdfParts, EachLobeGoesToItsSide) {
  struct Case {
    const char* name;
    SurfaceMaterial material;
    float threshold;
    bool wide, narrow;
    bool wide_transmits, narrow_transmits;
    bool narrow_delta;
  };
  SurfaceMaterial plastic;
  plastic.roughness = 0.2f;
  SurfaceMaterial mirror;
  mirror.metallic = 1.0f;
  mirror.roughness = 0.0f;
  SurfaceMaterial brass = mirror;
  brass.roughness = 0.4f;
  SurfaceMaterial window;
  window.transmission = 1.0f;
  window.roughness = 0.0f;
  SurfaceMaterial frosted = window;
  frosted.roughness = 0.3f;
  frosted.thin_walled = false;
  SurfaceMaterial air = frosted;
  air.ior = 1.0f;
  air.specular = 0.0f;
  SurfaceMaterial half_glass = frosted;
  half_glass.transmission = 0.5f;
  SurfaceMaterial varnish = brass;
  varnish.roughness = 0.6f;
  varnish.clearcoat = 1.0f;
  varnish.clearcoat_roughness = 0.1f;
  SurfaceMaterial velvet = mirror;
  velvet.sheen_color = Color(0.5f, 0.5f, 0.5f);
  const std::vector<Case> cases{
      {"plastic, deltas only", plastic, 0.0f, true, false, false, false, true},
      {"plastic at its own roughness", plastic, 0.2f, true, false, false, false, true},
      {"plastic above it", plastic, 0.21f, true, true, false, false, false},
      {"mirror", mirror, 0.0f, false, true, false, false, true},
      {"brass", brass, 0.3f, true, false, false, false, true},
      {"brass above its roughness", brass, 0.5f, false, true, false, false, false},
      {"window", window, 0.0f, false, true, false, true, true},
      {"frosted", frosted, 0.2f, true, false, true, false, true},
      {"frosted above its roughness", frosted, 0.4f, false, true, false, true, false},
      {"air", air, 0.0f, false, true, false, true, true},
      {"half glass, half white", half_glass, 0.4f, true, true, false, true, false},
      {"varnish on rough brass", varnish, 0.2f, true, true, false, false, false},
      {"varnish on rough brass, deltas only", varnish, 0.0f, true, false, false, false, true},
      {"velvet on a mirror", velvet, 0.0f, true, true, false, false, true},
  };
  const Vec3 n = Vec3::UnitZ();
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Bsdf whole(c.material, n, n, n, incident(0.7f), true);
    EXPECT_EQ(whole.has_wide(c.threshold), c.wide);
    EXPECT_EQ(whole.has_narrow(c.threshold), c.narrow);
    const Bsdf wide = whole.wide_part(c.threshold);
    const Bsdf narrow = whole.narrow_part(c.threshold);
    EXPECT_EQ(wide.transmits(), c.wide_transmits);
    EXPECT_EQ(narrow.transmits(), c.narrow_transmits);
    EXPECT_EQ(narrow.is_delta(), c.narrow_delta);
  }
}

TEST(BsdfParts, TheBaseIsNoBrighterWithoutItsGloss) {
  // Diffuse light under a smooth and under a rough dielectric lacks the light that the dielectric reflects.
  SurfaceMaterial material;
  material.roughness = 0.1f;
  const Vec3 n = Vec3::UnitZ();
  const Vec3 wo = incident(0.2f);
  const Bsdf wide = Bsdf(material, n, n, n, wo, true).wide_part(0.2f);
  material.specular = 0.0f;
  const Bsdf bare(material, n, n, n, wo, true);
  // Away from the mirror direction the whole has only its base.
  const Vec3 wi = Vec3(0.3f, 0.2f, 0.9f).normalized();
  EXPECT_LT(wide.evaluate(wi).value.x(), 0.8f * bare.evaluate(wi).value.x());
  EXPECT_LT(wide.albedo().x(), 0.8f);
}

}  // namespace
}  // namespace gatelight::renderer
