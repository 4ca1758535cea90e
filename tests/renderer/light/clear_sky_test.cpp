// The clear sky: its light, its sun and the sun's position, and its samples; and the sky of scenes without
// light.

#include "renderer/light/clear_sky.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "renderer/light/environment.h"
#include "renderer/light/soft_sky.h"
#include "renderer/light/solar_position.h"
#include "renderer/light/sun_disc.h"
#include "tests/support/light_scenes.h"
#include "tests/support/messages.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

/// Calls use(direction, solid angle) for the middles of cells of equal steps in both angles about +y.
template <class Use>
void each_direction(int rows, const Use& use) {
  const double step = M_PI / rows;
  for (int y = 0; y < rows; ++y) {
    const double theta = (y + 0.5) * step;
    for (int x = 0; x < 2 * rows; ++x) {
      const double phi = (x + 0.5) * step;
      use(Vec3(static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::cos(theta)),
               static_cast<float>(std::sin(theta) * std::sin(phi))),
          std::sin(theta) * step * step);
    }
  }
}

SkyOptions sky(float elevation, float turbidity = 3.0f, float azimuth = 0.0f) {
  return {.turbidity = turbidity, .sun_azimuth_degrees = azimuth, .sun_elevation_degrees = elevation};
}

/// North is -z and east +x.
Vec3 towards(float azimuth_degrees, float elevation_degrees) {
  const float a = azimuth_degrees * kPi / 180.0f, e = elevation_degrees * kPi / 180.0f;
  return {std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a)};
}

TEST(ClearSky, IsFiniteAndShinesFromDuskToNoonInAnyHaze) {
  for (const float elevation : {-10.0f, -5.0f, 0.0f, 0.1f, 5.0f, 30.0f, 90.0f}) {
    for (const float turbidity : {1.0f, 3.0f, 10.0f}) {
      const ClearSky s = make_clear_sky(sky(elevation, turbidity), 1.0f);
      SCOPED_TRACE(::testing::Message() << elevation << " degrees, turbidity " << turbidity);
      EXPECT_TRUE((s.picture.mean() > 0.0f).all());
      for (int i = 0; i < 200; ++i) {
        const Color c =
            s.picture.radiance(towards(7.3f * static_cast<float>(i), -89.0f + 0.9f * static_cast<float>(i)));
        ASSERT_TRUE(c.isFinite().all() && (c >= 0.0f).all()) << c.transpose();
      }
      EXPECT_TRUE(s.sun_irradiance.isFinite().all() && (s.sun_irradiance >= 0.0f).all());
    }
  }
  EXPECT_TRUE((make_clear_sky(sky(-1.0f), 1.0f).sun_irradiance == 0.0f).all());
}

TEST(ClearSky, IsBlueOverheadAtNoonAndRedAroundTheSunAtTheHorizon) {
  for (const float turbidity : {1.0f, 2.0f, 5.0f, 10.0f}) {
    const Color overhead = make_clear_sky(sky(45.0f, turbidity), 1.0f).picture.radiance(Vec3(0, 1, 0));
    EXPECT_GT(overhead.z(), 1.1f * overhead.x()) << turbidity;
    const Color low = make_clear_sky(sky(2.0f, turbidity), 1.0f).picture.radiance(towards(0.0f, 2.5f));
    EXPECT_GT(low.x(), 1.4f * low.z()) << turbidity;
  }
}

TEST(ClearSky, TheHorizonIsBrighterThanTheZenithAwayFromTheSun) {
  const ClearSky s = make_clear_sky(sky(40.0f, 2.0f), 1.0f);
  const float zenith = luminance(s.picture.radiance(Vec3(0, 1, 0)));
  EXPECT_GT(luminance(s.picture.radiance(towards(180.0f, 3.0f))), 1.5f * zenith);
}

TEST(ClearSky, ALowerSunIsDimmerAndRedder) {
  Color before = Color::Constant(1e9f);
  float redness = 0.0f;
  for (const float elevation : {90.0f, 60.0f, 40.0f, 20.0f, 10.0f, 5.0f, 2.0f, 0.0f}) {
    const Color sun = make_clear_sky(sky(elevation, 2.0f), 1.0f).sun_irradiance;
    EXPECT_TRUE((sun <= before).all()) << elevation;
    EXPECT_LT(luminance(sun), luminance(before)) << elevation;
    EXPECT_GT(sun.x() / sun.y(), redness) << elevation;
    before = sun;
    redness = sun.x() / sun.y();
  }
}

TEST(ClearSky, AWhiteFloorInFullDaylightHasARadianceOfAboutOne) {
  const ClearSky s = make_clear_sky(sky(60.0f), 1.0f);
  // Below the horizon lies a floor of albedo 0.2.
  const float floor = luminance(s.picture.radiance(Vec3(0, -1, 0))) / 0.2f;
  EXPECT_GT(floor, 0.8f);
  EXPECT_LT(floor, 1.3f);
  SkyOptions twice = sky(60.0f);
  twice.intensity = 2.0f;
  const ClearSky bright = make_clear_sky(twice, 3.0f);
  EXPECT_TRUE(bright.sun_irradiance.isApprox(6.0f * s.sun_irradiance, 1e-5f));
  EXPECT_TRUE(bright.picture.mean().isApprox(6.0f * s.picture.mean(), 1e-5f));
}

TEST(ClearSky, TheSunStandsAtItsGivenPositionAndTheSkyIsSymmetricAboutIt) {
  EnvironmentOptions options;
  options.sky = sky(30.0f, 3.0f, 70.0f);
  const Environment environment(options);
  const Color aureole = environment.radiance(towards(70.0f, 31.0f));
  EXPECT_GT(environment.radiance(towards(70.0f, 30.0f)).minCoeff(), 1000.0f * aureole.maxCoeff());
  EXPECT_LT(environment.radiance(towards(70.0f, 30.3f)).maxCoeff(), 2.0f * aureole.maxCoeff())
      << "beside the disc";
  for (const float side : {5.0f, 40.0f, 110.0f, 170.0f}) {
    for (const float elevation : {2.0f, 25.0f, 70.0f}) {
      const Color left = environment.radiance(towards(70.0f - side, elevation));
      EXPECT_TRUE(left.isApprox(environment.radiance(towards(70.0f + side, elevation)), 1e-3f)) << side;
    }
  }
  options.rotation_degrees = 90.0f;  // counter-clockwise
  EXPECT_GT(Environment(options).radiance(towards(-20.0f, 30.0f)).minCoeff(), 1000.0f * aureole.maxCoeff());
}

TEST(ClearSky, HasTheSameBitsForAnyNumberOfThreads) {
  const auto texels = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const ClearSky s = make_clear_sky(sky(17.0f), 1.0f);
    std::vector<float> values;
    for (int i = 0; i < 2000; ++i) {
      const float t = static_cast<float>(i);
      const Color c = s.picture.radiance(towards(11.3f * t, 0.09f * t - 80.0f));
      values.insert(values.end(), {c.x(), c.y(), c.z()});
    }
    for (int k = 0; k < 3; ++k) values.push_back(s.sun_irradiance[k]);
    return values;
  };
  const std::vector<float> one = texels(1);
  EXPECT_EQ(texels(2), one);
  EXPECT_EQ(texels(7), one);
}

/// The integral of radiance times cosine over the hemisphere of n: the picture by a midpoint rule, the disc
/// separately.
Color integrate(const Environment& environment, const SkyOptions& options, const Vec3& n) {
  SkyOptions without = options;
  without.sun_size_degrees = 0.0f;
  EnvironmentOptions plain;
  plain.sky = without;
  const Environment picture(plain);
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  each_direction(1024, [&](const Vec3& d, double solid_angle) {
    const double cosine = static_cast<double>(std::max(0.0f, n.dot(d)));
    sum += picture.radiance(d).cast<double>() * (solid_angle * cosine);
  });
  const Vec3 to_sun = towards(options.sun_azimuth_degrees, options.sun_elevation_degrees);
  const std::optional<DistantSun>& sun = picture.distant_sun();
  EXPECT_TRUE(sun && sun->direction.isApprox(to_sun, 1e-5f));
  EXPECT_FALSE(environment.distant_sun());
  const Color direct = sun->irradiance * std::max(0.0f, n.dot(to_sun));
  return sum.cast<float>() + direct;
}

TEST(ClearSky, SamplesAddUpToTheIrradiance) {
  for (const float elevation : {35.0f, 4.0f}) {
    EnvironmentOptions options;
    options.sky = sky(elevation, 3.0f, 200.0f);
    const Environment environment(options);
    for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0.6f, 0.0f, 0.8f), towards(20.0f, -30.0f), Vec3(0, -1, 0)}) {
      const Color expected = integrate(environment, *options.sky, n);
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      constexpr int kSide = 400;
      for (int i = 0; i < kSide * kSide; ++i) {
        const Vec2 u((static_cast<float>(i % kSide) + 0.5f) / kSide,
                     (static_cast<float>(i / kSide) + 0.5f) / kSide);
        const EnvironmentSample s = environment.sample(u, n);
        ASSERT_GT(s.pdf, 0.0f);
        sum += (s.radiance * (std::max(0.0f, n.dot(s.wi)) / s.pdf)).cast<double>();
      }
      const Color found = (sum / (kSide * kSide)).cast<float>();
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 0.01f * expected[c]) << elevation << ", " << n.transpose();
    }
  }
}

TEST(ClearSky, ADensityIsThatOfItsSamplesAndIntegratesToOne) {
  EnvironmentOptions options;
  options.sky = sky(20.0f);
  options.sky->sun_size_degrees = 20.0f;  // large enough for the midpoint rule
  const Environment environment(options);
  testing::Random random(5);
  for (const Vec3& n : {Vec3(0, 0, 0), Vec3(0, 1, 0), towards(180.0f, -40.0f)}) {
    int others = 0;  // at the borders of texels and of the disc rounding decides
    for (int i = 0; i < 20000; ++i) {
      const EnvironmentSample s = environment.sample(testing::next_2d(random), n);
      const float pdf = environment.pdf(s.wi, n);
      if (!(std::abs(pdf / s.pdf - 1.0f) < 1e-3f)) ++others;
      if (s.radiance.maxCoeff() > 0.0f) {
        EXPECT_TRUE(environment.radiance(s.wi).isApprox(s.radiance, 0.05f));
      }
    }
    EXPECT_LT(others, 10);
    double sum = 0.0;
    each_direction(1024, [&](const Vec3& d, double solid_angle) {
      sum += static_cast<double>(environment.pdf(d, n)) * solid_angle;
    });
    EXPECT_NEAR(sum, 1.0, 2e-3) << n.transpose();
  }
}

TEST(ClearSky, ASunWithoutASizeIsADirectionalLight) {
  EnvironmentOptions options;
  options.sky = sky(40.0f, 3.0f, 90.0f);
  options.sky->sun_size_degrees = 0.0f;
  const testing::LitScene lit({}, LightSelection::tree, options);
  ASSERT_EQ(lit.lights.distant().size(), 1u);
  const scene::PunctualLight& sun = lit.lights.distant()[0];
  EXPECT_TRUE(sun.direction.isApprox(-towards(90.0f, 40.0f), 1e-5f));
  EXPECT_TRUE((sun.intensity == make_clear_sky(*options.sky, 1.0f).sun_irradiance).all());
  EXPECT_TRUE(lit.lights.has_delta());
  options.sky->sun_elevation_degrees = -3.0f;
  EXPECT_TRUE(testing::LitScene({}, LightSelection::tree, options).lights.distant().empty());
}

TEST(ClearSky, ARisingDiscIsCutByTheHorizon) {
  const SunDisc disc(towards(0.0f, 0.0f), 0.01f, Color::Ones());
  testing::Random random(6);
  int above = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 d = disc.sample(testing::next_2d(random));
    ASSERT_NEAR((d - towards(0.0f, 0.0f)).norm(), 0.0f, 0.0101f);
    if (disc.radiance(d).x() > 0.0f) ++above;
  }
  EXPECT_NEAR(above, kSamples / 2, 400);
}

TEST(ClearSky, ExcludesAnotherEnvironment) {
  EnvironmentOptions options;
  options.sky = sky(40.0f);
  options.constant = Color::Ones();
  tests::expect_refusal<InputError>([&] { Environment{options}; }, {"`sky`", "`environment`"});
}

TEST(SoftSky, MakesWhiteSurfacesNeitherDarkNorOverexposed) {
  EnvironmentOptions options;
  options.automatic = true;
  const Environment sky(options);
  options.scale = 2.0f;
  const Environment twice(options);
  for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(1, 0, 0)}) {
    Color reflected = Color::Zero();
    each_direction(64, [&](const Vec3& d, double solid_angle) {
      const float share = static_cast<float>(solid_angle) / kPi;
      reflected += sky.radiance(d) * (std::max(0.0f, n.dot(d)) * share);
      EXPECT_TRUE(twice.radiance(d).isApprox(2.0f * sky.radiance(d), 1e-5f));
    });
    EXPECT_GT(reflected.minCoeff(), 0.2f) << n.transpose();
    EXPECT_LT(reflected.maxCoeff(), 1.2f) << n.transpose();
  }
}

int clock(int hour, int minute, int second = 0) {
  return (hour * 60 + minute) * 60 + second;
}

TEST(SolarPosition, IsThatOfTheExampleOfTheSolarPositionAlgorithm) {
  // Reda and Andreas 2004, NREL/TP-560-34302, table A5.1: with refraction, seen from the ground, at 1830 m.
  const SolarPosition sun = solar_position({.year = 2003,
                                            .month = 10,
                                            .day = 17,
                                            .second_of_day = clock(12, 30, 30),
                                            .zone_hours = -7.0,
                                            .latitude_degrees = 39.742476,
                                            .longitude_degrees = -105.1786});
  EXPECT_NEAR(sun.azimuth_degrees, 194.34024, 0.02);
  EXPECT_NEAR(sun.elevation_degrees, 90.0 - 50.11162, 0.03);
}

TEST(SolarPosition, ElevationAtThePoleIsTheDeclination) {
  // Meeus, "Astronomical Algorithms", example 25.a.
  const SolarPosition sun =
      solar_position({.year = 1992, .month = 10, .day = 13, .second_of_day = 0, .latitude_degrees = 90.0});
  EXPECT_NEAR(sun.elevation_degrees, -7.78507, 0.001);
}

TEST(SolarPosition, RisesAndCulminatesAtTheTimesOfAlmanacs) {
  // London at the solstice: sunrise 04:43 BST in the north-east (the centre is 0.83 degrees below the horizon
  // then).
  SunTime london{.year = 2026,
                 .month = 6,
                 .day = 21,
                 .second_of_day = clock(4, 43),
                 .zone_hours = 1.0,
                 .latitude_degrees = 51.5074,
                 .longitude_degrees = -0.1278};
  EXPECT_NEAR(solar_position(london).elevation_degrees, -0.833, 0.3);
  EXPECT_NEAR(solar_position(london).azimuth_degrees, 49.0, 0.5);
  // Solar noon at 13:02, at 90 - 51.51 + 23.44 degrees; sunset at 21:21.
  london.second_of_day = clock(13, 2);
  EXPECT_NEAR(solar_position(london).azimuth_degrees, 180.0, 0.5);
  EXPECT_NEAR(solar_position(london).elevation_degrees, 61.93, 0.05);
  london.second_of_day = clock(21, 21);
  EXPECT_NEAR(solar_position(london).elevation_degrees, -0.833, 0.3);
  EXPECT_NEAR(solar_position(london).azimuth_degrees, 311.0, 0.5);
  // South of the tropics the sun culminates in the north: Sydney, 21 December 2026, 12:53 AEDT.
  const SolarPosition sydney = solar_position({.year = 2026,
                                               .month = 12,
                                               .day = 21,
                                               .second_of_day = clock(12, 53),
                                               .zone_hours = 11.0,
                                               .latitude_degrees = -33.8688,
                                               .longitude_degrees = 151.2093});
  EXPECT_NEAR(sydney.elevation_degrees, 90.0 - 33.87 + 23.44, 0.1);
  EXPECT_NEAR(std::remainder(sydney.azimuth_degrees, 360.0), 0.0, 1.5);
}

TEST(SolarPosition, AClockFurtherEastShowsALaterTime) {
  SunTime time{
      .second_of_day = clock(9, 0), .zone_hours = 0.0, .latitude_degrees = 40.0, .longitude_degrees = 10.0};
  const SolarPosition utc = solar_position(time);
  time.second_of_day = clock(14, 30);
  time.zone_hours = 5.5;
  EXPECT_NEAR(solar_position(time).elevation_degrees, utc.elevation_degrees, 1e-6);
  EXPECT_NEAR(solar_position(time).azimuth_degrees, utc.azimuth_degrees, 1e-6);
}

}  // namespace
}  // namespace gatelight::renderer
