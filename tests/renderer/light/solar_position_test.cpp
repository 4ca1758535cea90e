// The sun's position against published values.

#include "renderer/light/solar_position.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gatelight::renderer {
namespace {

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
