#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/renderer/bsdf/bsdf_measures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;

std::array<Bsdf, 2> parts(const Bsdf& whole, float roughness) {
  return {whole.wide_part(roughness), whole.narrow_part(roughness)};
}

TEST(BsdfPartsFurnace, AlbedoIsTheReflectanceInAFurnace) {
  Random random(1);
  for (const BsdfCase& c : colored_cases()) {
    const bool refracts = c.material.transmission > 0.0f && !c.material.thin_walled;
    if (refracts && c.material.ior > 1.5f) continue;  // as for the whole
    for (const float roughness : {0.0f, 0.15f, 0.5f}) {
      for (const float cosine : {0.9f, 0.3f, 0.05f}) {
        const Bsdf whole = flat_bsdf(c, roughness, incident(cosine));
        for (const float threshold : {0.0f, 0.3f}) {
          for (const Bsdf& part : parts(whole, threshold)) {
            const Furnace result = furnace(part, random, 20);
            double tolerance = (refracts && roughness > 0.0f ? 0.05 : 0.003) + 3.0 * result.error;
            if (c.material.anisotropy > 0.0f) tolerance += 0.012;  // as for the whole
            if (c.material.iridescence > 0.0f) tolerance += 0.08;
            for (int k = 0; k < 3; ++k) {
              EXPECT_NEAR(result.mean[k], static_cast<double>(part.albedo()[k]), tolerance)
                  << describe(c, roughness, cosine) << ", split at " << threshold << ", channel " << k;
            }
          }
        }
      }
    }
  }
}

TEST(BsdfPartsSampling, SamplesFollowTheDensity) {
  constexpr int kSamples = 30000;
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
          EXPECT_TRUE(testing::accepts(samples_against_density(part, 4, kSamples, c.symmetric(), random),
                                       significance));
        }
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
