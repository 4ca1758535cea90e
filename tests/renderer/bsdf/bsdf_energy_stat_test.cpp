#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/renderer/bsdf/bsdf_measures.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;

constexpr std::array<float, 7> kRoughnesses{0.0f, 0.05f, 0.15f, 0.3f, 0.5f, 0.75f, 1.0f};
constexpr std::array<float, 6> kCosines{1.0f, 0.7f, 0.4f, 0.15f, 0.05f, 0.02f};

TEST(BsdfFurnace, WhiteSurfacesReturnAllLight) {
  Random random(3);
  for (const BsdfCase& c : white_cases()) {
    const bool refracts = c.material.transmission > 0.0f && !c.material.thin_walled;
    // Tables interpolate: within 1 % below, and above by 0.2 %, 0.5 % with the coarser ones.
    double above = refracts || (c.material.sheen_color > 0.0f).any() ? 0.005 : 0.002;
    if (c.material.anisotropy > 0.0f) above = 0.012;
    // A film's reflectance at the angle of the surface is used for all its microfacets.
    if (c.material.iridescence > 0.0f) above = 0.04;
    for (const float roughness : kRoughnesses) {
      for (const float cosine : kCosines) {
        const Bsdf bsdf = flat_bsdf(c, roughness, incident(cosine));
        const Furnace result = furnace(bsdf, random);
        const double noise = std::min(3.0 * result.error, 0.004);
        // Under a film the channel with the highest reflectance decides the light of the base.
        const double below = c.material.iridescence > 0.0f ? 0.12 : 0.01;
        EXPECT_GT(result.mean[0], 1.0 - below - noise) << describe(c, roughness, cosine);
        EXPECT_LT(result.mean[0], 1.0 + above + noise) << describe(c, roughness, cosine);
      }
    }
  }
}

TEST(BsdfFurnace, AlbedoIsTheReflectanceInAFurnace) {
  Random random(4);
  for (const BsdfCase& c : cases_of_albedos()) {
    for (const float roughness : kRoughnesses) {
      for (const float cosine : {0.9f, 0.3f, 0.05f}) {
        SCOPED_TRACE(describe(c, roughness, cosine));
        const Bsdf bsdf = flat_bsdf(c, roughness, incident(cosine));
        expect_albedo(bsdf, c, roughness, furnace(bsdf, random));
      }
    }
  }
}

TEST(BsdfFurnace, AlbedoOfAPartIsItsReflectanceInAFurnace) {
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

TEST(BsdfFurnace, BlackSurfacesReturnOnlyTheSpecularPart) {
  Random random(5);
  SurfaceMaterial material;
  material.base_color = Color(0.0f, 0.0f, 0.0f);
  material.roughness = 0.0f;
  const Vec3 n = Vec3::UnitZ();
  for (const float cosine : kCosines) {
    const Bsdf bsdf(material, n, n, n, incident(cosine), true);
    // Schlick's curve from 4 % to 1.
    const double expected = 0.04 + 0.96 * std::pow(1.0 - static_cast<double>(cosine), 5.0);
    EXPECT_NEAR(furnace(bsdf, random).mean[0], expected, 1e-5);
  }
  material.metallic = 1.0f;
  material.roughness = 0.4f;
  material.specular = 0.0f;
  const Bsdf metal(material, n, n, n, incident(0.9f), true);
  // Black metal reflects at grazing half vectors only.
  EXPECT_LT(furnace(metal, random).mean[0], 0.01);
}

TEST(BsdfFurnace, SmoothConductorIsSchlicksCurve) {
  SurfaceMaterial material;
  material.metallic = 1.0f;
  material.roughness = 0.0f;
  material.base_color = Color(0.9f, 0.5f, 0.2f);
  const Vec3 n = Vec3::UnitZ();
  for (const float cosine : kCosines) {
    const Bsdf bsdf(material, n, n, n, incident(cosine), true);
    EXPECT_TRUE(bsdf.is_delta());
    const BsdfSample sample = bsdf.sample(0.5f, {0.1f, 0.2f});
    for (int k = 0; k < 3; ++k) {
      const double f0 = static_cast<double>(material.base_color[k]);
      const double expected = f0 + (1.0 - f0) * std::pow(1.0 - static_cast<double>(cosine), 5.0);
      EXPECT_NEAR(static_cast<double>(sample.weight[k]), expected, 1e-5);
    }
    EXPECT_NEAR((sample.wi - Vec3(-incident(cosine).x(), 0.0f, cosine)).norm(), 0.0f, 1e-6f);
  }
}

TEST(BsdfFurnace, GlassBallIsInvisibleInAWhiteRoom) {
  // Camera paths through a ball, by the ball's symmetry: every hit from inside has the angle it left with.
  for (const float roughness : {0.0f, 0.2f, 0.6f, 1.0f}) {
    Random random(6);
    testing::Moments radiance;
    for (int path = 0; path < 40000; ++path) {
      const float cosine = std::sqrt(random.uniform_float());
      SurfaceMaterial material;
      material.transmission = 1.0f;
      material.thin_walled = false;
      material.roughness = roughness;
      Vec3 n = Vec3::UnitZ();
      Vec3 wo = incident(std::max(cosine, 1e-3f));
      bool front = true;
      double weight = 1.0;
      for (int bounce = 0; bounce < 400 && weight > 0.0; ++bounce) {
        const Bsdf bsdf(material, n, n, n, wo, front);
        const BsdfSample sample =
            bsdf.sample(random.uniform_float(), {random.uniform_float(), random.uniform_float()});
        weight *= static_cast<double>(sample.weight.x());
        const bool inside = front == sample.transmitted;
        if (!inside) break;
        // From the point at n (front) or -n (inside) along wi to the other side of the unit ball.
        const Vec3 from = front ? n : Vec3(-n);
        const Vec3 to = (from - 2.0f * from.dot(sample.wi) * sample.wi).normalized();
        n = -to;
        wo = -sample.wi;
        front = false;
      }
      radiance.add(weight);
    }
    // The noise comes from the tables; deltas have none.
    EXPECT_NEAR(radiance.mean(), 1.0, 0.01 + 4.0 * radiance.standard_error()) << "roughness " << roughness;
    if (roughness == 0.0f) {
      EXPECT_NEAR(radiance.mean(), 1.0, 1e-4);
    }
    EXPECT_LT(radiance.standard_error(), 0.005) << "roughness " << roughness;
  }
}

}  // namespace
}  // namespace gatelight::renderer
