#include "renderer/bsdf/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/bsdf/bsdf_cases.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;

Vec3 random_direction(Random& random) {
  return sample_uniform_sphere({random.uniform_float(), random.uniform_float()});
}

SurfaceMaterial random_material(Random& random) {
  // Extremes are as frequent as the middle.
  const auto unit = [&] {
    const double u = random.uniform();
    return u < 0.2 ? 0.0f : u < 0.4 ? 1.0f : random.uniform_float();
  };
  SurfaceMaterial m;
  m.base_color = Color(unit(), unit(), unit());
  m.metallic = unit();
  m.roughness = unit();
  const double ior = random.uniform();
  m.ior = ior < 0.1 ? 0.0f : ior < 0.3 ? 1.0f : 1.0f + 2.0f * unit();
  m.specular = unit();
  m.specular_color = Color(unit(), unit(), unit());
  m.transmission = unit();
  m.thin_walled = random.uniform() < 0.5;
  m.clearcoat = unit();
  m.clearcoat_roughness = unit();
  m.sheen_color = Color(unit(), unit(), unit());
  m.sheen_roughness = unit();
  return m;
}

bool finite(const Color& c) {
  return std::isfinite(c.x()) && std::isfinite(c.y()) && std::isfinite(c.z());
}

TEST(BsdfProperties, ReflectionIsReciprocal) {
  Random random(1);
  for (const BsdfCase& c : colored_cases()) {
    if (c.layered) continue;  // scaled by the transmittance of the layer above towards wo only
    for (int i = 0; i < 2000; ++i) {
      const float roughness = 0.1f + 0.9f * random.uniform_float();
      Vec3 a = random_direction(random);
      Vec3 b = random_direction(random);
      a.z() = std::abs(a.z());
      b.z() = std::abs(b.z());
      // Below the cosine that bends normals the frame depends on the direction.
      if (a.z() < 0.01f || b.z() < 0.01f) continue;
      const Color there = flat_bsdf(c, roughness, a).evaluate(b).value / b.z();
      const Color back = flat_bsdf(c, roughness, b).evaluate(a).value / a.z();
      for (int k = 0; k < 3; ++k) {
        ASSERT_NEAR(there[k], back[k], 5e-3f * std::max(there[k], 1e-3f))
            << c.name << ", roughness " << roughness;
      }
    }
  }
}

TEST(BsdfProperties, TransmissionIsReciprocalButForTheSquareOfTheIndex) {
  Random random(2);
  int compared = 0;
  for (BsdfCase c : colored_cases()) {
    if (c.material.transmission == 0.0f || c.name == "clear") continue;
    const float ior = c.material.thin_walled ? 1.0f : c.material.ior;
    for (int i = 0; i < 4000; ++i) {
      const float roughness = 0.2f + 0.8f * random.uniform_float();
      Vec3 outside = random_direction(random);
      Vec3 inside = random_direction(random);
      outside.z() = std::abs(outside.z());
      inside.z() = -std::abs(inside.z());
      if (outside.z() < 0.01f || inside.z() > -0.01f) continue;
      c.front = true;
      const Color in = flat_bsdf(c, roughness, outside).evaluate(inside).value / -inside.z();
      // The geometric normal is on the side of wo: seen from inside everything is mirrored.
      c.front = false;
      const Vec3 wo(inside.x(), inside.y(), -inside.z());
      const Vec3 wi(outside.x(), outside.y(), -outside.z());
      const Color out = flat_bsdf(c, roughness, wo).evaluate(wi).value / outside.z();
      for (int k = 0; k < 3; ++k) {
        // f(wo, wi) n_i^2 = f(wi, wo) n_o^2
        const float a = in[k] * (ior * ior);
        const float b = out[k];
        ASSERT_NEAR(a, b, 5e-3f * std::max(a, 1e-3f)) << c.name << ", roughness " << roughness;
        compared += a > 1e-3f;
      }
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(BsdfProperties, NormalMapsNeverLeakLight) {
  Random random(3);
  for (int i = 0; i < 60000; ++i) {
    SurfaceMaterial material = random_material(random);
    if (random.uniform() < 0.5) material.transmission = 0.0f;
    const Vec3 ng = random_direction(random);
    Vec3 wo = random_direction(random);
    Vec3 ns = random_direction(random);
    Vec3 nc = random_direction(random);
    if (wo.dot(ng) < 0.0f) wo = -wo;
    if (ns.dot(ng) < 0.0f) ns = -ns;
    if (nc.dot(ng) < 0.0f) nc = -nc;
    const Bsdf bsdf(material, ng, ns, nc, wo, random.uniform() < 0.5);
    const Vec3 wi = random_direction(random);
    const BsdfValue value = bsdf.evaluate(wi);
    if (wi.dot(ng) < 0.0f && !bsdf.transmits()) {
      ASSERT_EQ(value.pdf, 0.0f);
      ASSERT_TRUE((value.value == 0.0f).all());
    }
    const BsdfSample sample =
        bsdf.sample(random.uniform_float(), {random.uniform_float(), random.uniform_float()});
    if ((sample.weight > 0.0f).any()) {
      ASSERT_EQ(sample.transmitted, sample.wi.dot(ng) < 0.0f);
      if (!bsdf.transmits()) {
        ASSERT_FALSE(sample.transmitted);
      }
    }
  }
}

TEST(BsdfProperties, MirrorDirectionIsAboveTheSurfaceForAnyShadingNormal) {
  Random random(4);
  SurfaceMaterial material;
  material.metallic = 1.0f;
  material.roughness = 0.0f;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 ng = random_direction(random);
    Vec3 wo = random_direction(random);
    Vec3 ns = random_direction(random);
    if (wo.dot(ng) < 0.0f) wo = -wo;
    if (ns.dot(ng) < 0.0f) ns = -ns;
    if (wo.dot(ng) < 1e-3f) continue;
    const BsdfSample sample = Bsdf(material, ng, ns, ns, wo, true).sample(0.5f, {0.5f, 0.5f});
    ASSERT_GT(sample.wi.dot(ng), 0.0f);
    ASSERT_GT(sample.weight.minCoeff(), 0.99f);
  }
}

TEST(BsdfProperties, ResultsAreFiniteAndNotNegative) {
  Random random(5);
  for (int i = 0; i < 200000; ++i) {
    const SurfaceMaterial material = random_material(random);
    const Vec3 ng = random_direction(random);
    Vec3 ns = random.uniform() < 0.5 ? ng : random_direction(random);
    Vec3 nc = random.uniform() < 0.5 ? ng : random_direction(random);
    Vec3 wo = random_direction(random);
    const double angle = random.uniform();
    if (angle < 0.2) wo = (wo - wo.dot(ng) * ng).normalized();  // in the plane of the surface
    if (angle > 0.9) wo = ng;
    if (wo.dot(ng) < 0.0f) wo = (wo - 2.0f * wo.dot(ng) * ng).normalized();
    if (ns.dot(ng) < 0.0f) ns = -ns;
    if (nc.dot(ng) < 0.0f) nc = -nc;
    const Bsdf whole(material, ng, ns, nc, wo, random.uniform() < 0.5);
    const double kept = random.uniform();
    const float split = random.uniform_float();
    const Bsdf bsdf = kept < 0.5 ? whole : kept < 0.75 ? whole.wide_part(split) : whole.narrow_part(split);
    ASSERT_TRUE(finite(bsdf.albedo())) << bsdf.albedo();
    ASSERT_GE(bsdf.albedo().minCoeff(), 0.0f);
    ASSERT_LE(bsdf.albedo().maxCoeff(), 1.0f);
    ASSERT_TRUE(finite(bsdf.unrefracted_transmittance()));

    Vec3 wi = random_direction(random);
    const double choice = random.uniform();
    if (choice < 0.1) wi = -wo;
    if (choice > 0.9) wi = wo;
    if (choice > 0.4 && choice < 0.5) wi = (wi - wi.dot(ng) * ng).normalized();
    const BsdfValue value = bsdf.evaluate(wi);
    ASSERT_TRUE(finite(value.value) && std::isfinite(value.pdf));
    ASSERT_GE(value.value.minCoeff(), 0.0f);
    ASSERT_GE(value.pdf, 0.0f);

    const float u_lobe = random.uniform() < 0.05 ? 1.0f - 0x1p-24f : random.uniform_float();
    const Vec2 u = random.uniform() < 0.05 ? Vec2(0.0f, 1.0f - 0x1p-24f)
                                           : Vec2(random.uniform_float(), random.uniform_float());
    const BsdfSample sample = bsdf.sample(u_lobe, u);
    ASSERT_TRUE(finite(sample.weight) && std::isfinite(sample.pdf) && sample.wi.allFinite());
    ASSERT_GE(sample.weight.minCoeff(), 0.0f);
    if (sample.pdf > 0.0f) {
      ASSERT_NEAR(sample.wi.norm(), 1.0f, 1e-4f);
    }
  }
}

TEST(BsdfProperties, NothingIsReflectedInThePlaneOfTheShadingNormal) {
  const Vec3 ng = Vec3(0.6f, 0.0f, 0.8f);
  for (const BsdfCase& c : colored_cases()) {
    SurfaceMaterial material = c.material;
    material.roughness = 0.5f;
    const Bsdf bsdf(material, ng, Vec3::UnitZ(), ng, Vec3::UnitZ(), c.front);
    const BsdfValue value = bsdf.evaluate(Vec3::UnitX());
    const bool layer = material.clearcoat > 0.0f || (material.sheen_color > 0.0f).any();
    if (layer) continue;  // the coat has a normal of its own
    EXPECT_TRUE((value.value == 0.0f).all()) << c.name;
    EXPECT_EQ(value.pdf, 0.0f) << c.name;
  }
}

/// The threshold in renderer/bsdf/README.md.
TEST(BsdfProperties, ALobeIsADeltaBelowTheRoughness003) {
  SurfaceMaterial metal;
  metal.metallic = 1.0f;
  const BsdfCase mirror{.name = "metal", .material = metal};
  EXPECT_TRUE(flat_bsdf(mirror, 0.0f, incident(0.6f)).is_delta());
  EXPECT_TRUE(flat_bsdf(mirror, 0.0299f, incident(0.6f)).is_delta());
  EXPECT_FALSE(flat_bsdf(mirror, 0.0301f, incident(0.6f)).is_delta());
}

TEST(BsdfProperties, SmoothLimitIsTheDelta) {
  const float smooth = kDeltaRoughness;
  Random random(6);
  for (const BsdfCase& c : colored_cases()) {
    for (const float cosine : {1.0f, 0.6f, 0.2f}) {
      SCOPED_TRACE(describe(c, smooth, cosine));
      const Bsdf delta = flat_bsdf(c, 0.999f * smooth, incident(cosine));
      const Bsdf rough = flat_bsdf(c, 1.001f * smooth, incident(cosine));
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(delta.albedo()[k], rough.albedo()[k], 0.02f);
      // The same numbers give nearly the same directions.
      for (int i = 0; i < 50; ++i) {
        const float u_lobe = random.uniform_float();
        const Vec2 u(random.uniform_float(), 0.3f * random.uniform_float());
        const BsdfSample a = delta.sample(u_lobe, u);
        const BsdfSample b = rough.sample(u_lobe, u);
        if (!a.delta || a.transmitted != b.transmitted) continue;
        EXPECT_LT((a.wi - b.wi).norm(), 0.03f);
      }
    }
  }
}

TEST(BsdfProperties, UnrefractedTransmittanceIsTheMeanOfTheUnrefractedSamples) {
  Random random(7);
  SurfaceMaterial material;
  material.base_color = Color(0.9f, 0.5f, 0.3f);
  material.transmission = 0.7f;
  material.roughness = 0.0f;
  material.clearcoat = 0.5f;
  const Vec3 n = Vec3::UnitZ();
  const Vec3 wo = incident(0.4f);
  const Bsdf bsdf(material, n, n, n, wo, true);
  testing::Moments red;
  for (int i = 0; i < 100000; ++i) {
    const BsdfSample sample =
        bsdf.sample(random.uniform_float(), {random.uniform_float(), random.uniform_float()});
    const bool straight = sample.delta && sample.transmitted;
    if (straight) {
      EXPECT_LT((sample.wi + wo).norm(), 1e-6f);
    }
    red.add(straight ? static_cast<double>(sample.weight.x()) : 0.0);
  }
  EXPECT_GT(testing::mean_p_value(red, static_cast<double>(bsdf.unrefracted_transmittance().x())), 1e-5);
  material.roughness = 0.3f;
  EXPECT_TRUE((Bsdf(material, n, n, n, wo, true).unrefracted_transmittance() == 0.0f).all());
  material.roughness = 0.0f;
  material.thin_walled = false;
  EXPECT_TRUE((Bsdf(material, n, n, n, wo, true).unrefracted_transmittance() == 0.0f).all());
}

TEST(BsdfProperties, SmoothGlassFollowsSnellAndFresnel) {
  SurfaceMaterial material;
  material.transmission = 1.0f;
  material.thin_walled = false;
  material.roughness = 0.0f;
  material.ior = 1.5f;
  const Vec3 n = Vec3::UnitZ();
  const Vec3 wo = incident(0.6f);
  const BsdfSample in = Bsdf(material, n, n, n, wo, true).sample(0.99f, {0.5f, 0.5f});
  ASSERT_TRUE(in.delta && in.transmitted);
  // sin 0.8 outside is 0.8 / 1.5 inside; radiance grows by 1.5^2 on the way in, so a camera path's falls.
  EXPECT_NEAR(in.wi.x(), -0.8f / 1.5f, 1e-6f);
  EXPECT_NEAR(in.weight.x(), 1.0f / 2.25f, 1e-5f);
  EXPECT_NEAR(in.radiance_scale, 1.0f / 2.25f, 1e-6f);
  // Fresnel at cos 0.6: cos_t = sqrt(1 - 0.64 / 2.25).
  const double t = std::sqrt(1.0 - 0.64 / 2.25);
  const double s = (0.6 - 1.5 * t) / (0.6 + 1.5 * t);
  const double p = (1.5 * 0.6 - t) / (1.5 * 0.6 + t);
  EXPECT_NEAR(static_cast<double>(in.pdf), 1.0 - 0.5 * (s * s + p * p), 1e-5);
  // Beyond the critical angle everything is reflected.
  const BsdfSample total = Bsdf(material, n, n, n, incident(0.5f), false).sample(0.9999f, {0.5f, 0.5f});
  EXPECT_FALSE(total.transmitted);
  EXPECT_NEAR(total.weight.x(), 1.0f, 1e-6f);
}

}  // namespace
}  // namespace gatelight::renderer
