#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/renderer/bsdf/bsdf_measures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;

TEST(BsdfSampling, SamplesFollowTheDensity) {
  constexpr int kSamples = 60000;
  std::vector<BsdfCase> cases = colored_cases();
  std::erase_if(cases, [](const BsdfCase& c) { return c.name == "ior 0" || c.name == "ior 3"; });
  const std::array<float, 3> roughnesses{0.25f, 0.5f, 1.0f};
  const std::array<float, 3> cosines{1.0f, 0.5f, 0.02f};
  const double significance = testing::sidak(1e-4, cases.size() * roughnesses.size() * cosines.size());
  Random random(7);
  for (const BsdfCase& c : cases) {
    for (const float roughness : roughnesses) {
      for (const float cosine : cosines) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        const Bsdf bsdf = flat_bsdf(c, roughness, incident(cosine));
        const bool narrow =
            roughness < 0.3f || (c.material.clearcoat > 0.0f && c.material.clearcoat_roughness < 0.3f);
        EXPECT_TRUE(testing::accepts(
            samples_against_density(bsdf, narrow ? 5 : 3, kSamples, c.symmetric(), random), significance));
      }
    }
  }
}

TEST(BsdfSampling, SamplesOfPartsFollowTheDensity) {
  std::vector<BsdfCase> cases = colored_cases();
  std::erase_if(cases, [](const BsdfCase& c) {
    return c.name != "half metal" && c.name != "thin" && c.name != "half glass" && c.name != "coat" &&
           c.name != "rough sheen under coat";
  });
  ASSERT_EQ(cases.size(), 5u);
  Random random(2);
  const double significance = testing::sidak(1e-4, cases.size() * 2 * 2 * 2);
  for (const BsdfCase& c : cases) {
    for (const float roughness : {0.3f, 0.7f}) {
      for (const float cosine : {0.8f, 0.1f}) {
        // A threshold of 0.45 separates the base's microfacets, or the coat, from the rest.
        for (const Bsdf& part : parts(flat_bsdf(c, roughness, incident(cosine)), 0.45f)) {
          SCOPED_TRACE(describe(c, roughness, cosine));
          EXPECT_TRUE(
              testing::accepts(samples_against_density(part, 4, 30000, c.symmetric(), random), significance));
        }
      }
    }
  }
}

TEST(BsdfSampling, EveryLobeIsSampledAtBothEndsOfItsShare) {
  // The largest number below one must not fall through to no lobe at all.
  const float last = 1.0f - 0x1p-24f;
  for (const BsdfCase& c : colored_cases()) {
    for (const float roughness : {0.0f, 0.5f, 1.0f}) {
      SCOPED_TRACE(describe(c, roughness, 0.8f));
      const Bsdf bsdf = flat_bsdf(c, roughness, incident(0.8f));
      EXPECT_GT(bsdf.sample(0.0f, {0.3f, 0.3f}).pdf, 0.0f);
      EXPECT_GT(bsdf.sample(last, {0.3f, 0.3f}).pdf, 0.0f);
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
