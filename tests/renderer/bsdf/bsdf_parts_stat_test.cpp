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
  for (const BsdfCase& c : cases_of_albedos()) {
    for (const float roughness : {0.0f, 0.15f, 0.5f}) {
      for (const float cosine : {0.9f, 0.3f, 0.05f}) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        for (const float threshold : {0.0f, 0.3f}) {
          for (const Bsdf& part : parts(flat_bsdf(c, roughness, incident(cosine)), threshold))
            expect_albedo(part, c, roughness, furnace(part, random, 20));
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
