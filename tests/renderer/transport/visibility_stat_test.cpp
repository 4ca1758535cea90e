// Objects and environments that only some rays see: closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "renderer/render.h"
#include "tests/support/light_scenes.h"
#include "tests/support/messages.h"
#include "tests/support/sheltered_floor.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using scene::RayKinds;
using testing::Moments;
using testing::ShelteredFloor;

// Of the means of this file.
const double kVisibilitySignificance = testing::sidak(1e-4, 60);

void expect_visible(const Moments& moments, double expected) {
  EXPECT_GT(testing::mean_p_value(moments, expected, 1e-4), kVisibilitySignificance)
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

constexpr RayKinds kCamera = scene::kCameraRays, kDiffuse = scene::kDiffuseRays, kGlossy = scene::kGlossyRays,
                   kTransmission = scene::kTransmissionRays, kVolume = scene::kVolumeRays,
                   kShadow = scene::kShadowRays, kBounces = scene::kBounceRays;

/// What the camera sees where the walls are hidden from these rays.
struct HiddenFromRays {
  RayKinds from;
  double seen;
};

void expect_seen(const std::function<ShelteredFloor()>& make, const std::vector<HiddenFromRays>& cases) {
  for (const HiddenFromRays& each : cases) {
    ShelteredFloor floor = make();
    floor.hide_walls(each.from);
    SCOPED_TRACE(::testing::Message() << "hidden from " << static_cast<int>(each.from));
    expect_visible(floor.seen(), each.seen);
  }
}

constexpr double kLit = static_cast<double>(ShelteredFloor::kAlbedo);

TEST(HiddenFrom, DiffuseRaysLetTheSkyLightAFloor) {
  // Bounces alone find a constant sky where shadow rays meet other objects.
  expect_seen([] { return ShelteredFloor(ShelteredFloor::matte()); },
              {{0, 0.0},
               {kBounces | kShadow, kLit},
               {kDiffuse | kShadow, kLit},
               {kDiffuse, kLit},
               {kBounces, kLit},
               {kShadow, 0.0},
               {testing::all_but(kDiffuse | kShadow), 0.0}});
}

TEST(HiddenFrom, DiffuseRaysLetTheSkyInBesideALamp) {
  for (const RayKinds from : {kShadow, kBounces}) {
    ShelteredFloor floor(ShelteredFloor::matte());
    floor.scene().lights = {testing::point_light(Vec3(0, 2, 0), Color::Constant(3.0f))};
    floor.hide_walls(from);
    floor.options.spp = 256;
    expect_visible(floor.seen(), kLit * (3.0 / 4.0 / M_PI + (from == kBounces ? 1.0 : 0.0)));
  }
}

TEST(HiddenFrom, ShadowRaysLetTheLightSamplesOfASkyThrough) {
  // Of a picture. With MIS, bounces have the share of the integral of 2 c w, where their weight w is
  // c^2 / (c^2 + 1/16) by the power heuristic: the densities are c / pi, and 1 / (4 pi) all around.
  const double share = 1.0 - std::log(17.0) / 16.0;
  const tests::TemporaryFolder folder;
  const EnvironmentOptions sky = testing::uniform_picture(folder, 1.0f);
  struct Case {
    DirectLight direct;
    double of_bounces;
  };
  for (const auto& [direct, of_bounces] :
       {Case{DirectLight::nee, 0.0}, Case{DirectLight::mis, share}, Case{DirectLight::bsdf, 1.0}}) {
    for (const RayKinds from : {kShadow, kBounces}) {
      ShelteredFloor floor(ShelteredFloor::matte());
      floor.options.environment = sky;
      floor.options.direct = direct;
      floor.options.spp = 256;
      floor.hide_walls(from);
      SCOPED_TRACE(::testing::Message() << static_cast<int>(direct) << ", " << static_cast<int>(from));
      expect_visible(floor.seen(), kLit * (from == kBounces ? of_bounces : 1.0 - of_bounces));
    }
  }
}

TEST(HiddenFrom, GlossyRaysLetAMirrorShowTheSky) {
  expect_seen([] { return ShelteredFloor(testing::mirror()); },
              {{0, 0.0}, {kGlossy, 0.9}, {testing::all_but(kGlossy), 0.0}, {kDiffuse, 0.0}, {kShadow, 0.0}});
}

TEST(HiddenFrom, TransmissionRaysAreVisibleThroughBodiesOnly) {
  const auto behind = [](bool pane) {
    ShelteredFloor floor;
    scene::Material glass = testing::solid_glass(1.0f);
    if (pane) glass.thickness = 0.0f;
    floor.box(floor.material(glass), Vec3(-1, 0, -1), Vec3(1, 1, 1));
    floor.scene().instances.back().placement = 1;
    return floor;
  };
  expect_seen([&] { return behind(false); },
              {{0, 0.0}, {kTransmission, 1.0}, {testing::all_but(kTransmission), 0.0}, {kCamera, 0.0}});
  expect_seen([&] { return behind(true); }, {{0, 0.0}, {kCamera, 1.0}, {testing::all_but(kCamera), 0.0}});
}

/// Fog in front of the camera and around it, up to a little beyond the walls.
ShelteredFloor foggy_floor() {
  ShelteredFloor floor;
  floor.options.environment.fog = FogOptions{.density = 0.2f};
  floor.options.min_depth = 1000;
  floor.options.spp = 256;
  return floor;
}
const double kPassed = std::exp(-0.2 * 7.0), kPassedBeyond = std::exp(-0.2 * (7.0 + 0.01 * std::sqrt(3.0)));

TEST(HiddenFrom, VolumeRaysLetTheSkyLightFog) {
  // The part of the light that is scattered.
  expect_seen(foggy_floor,
              {{0, 0.0}, {kVolume | kShadow, 1.0 - kPassed}, {kVolume, 1.0 - kPassed}, {kShadow, 0.0}});
  ShelteredFloor open = foggy_floor();
  open.hide_walls(testing::all_but(kVolume | kShadow));
  EXPECT_NEAR(open.seen().mean(), kPassedBeyond, 0.002) << "and a little light from beyond the walls";
}

TEST(HiddenFrom, CameraRaysLetTheBackgroundBeSeen) {
  expect_seen([] { return ShelteredFloor(); }, {{0, 0.0}, {kCamera, 1.0}, {testing::all_but(kCamera), 0.0}});
}

TEST(HiddenFrom, CameraRaysKeepsTheShadow) {
  ShelteredFloor floor(ShelteredFloor::matte());
  floor.box(0, Vec3(-3, 1, -3), Vec3(3, 1.5f, 3));
  floor.hide_walls(scene::kAllRays);
  floor.scene().lights = {testing::sun(Vec3(0, -1, 0))};
  floor.options.environment = {};
  EXPECT_EQ(floor.seen().mean(), 0.0);
  floor.scene().instances.back().visibility.rays = testing::all_but(kCamera);
  EXPECT_EQ(floor.seen().mean(), 0.0);
  floor.scene().instances.back().visibility.rays = testing::all_but(kCamera | kShadow);
  expect_visible(floor.seen(), kLit / M_PI);
}

/// The view of a floor in an open environment that only these rays see.
double seen_in_environment(const scene::Material& floor_material, RayKinds rays, bool up = false) {
  ShelteredFloor floor(floor_material);
  floor.hide_walls(scene::kAllRays);
  floor.scene().environment_rays = rays;
  if (up) floor.options.camera.look_at->target = Vec3(0, 4, 0);
  return floor.seen().mean();
}

TEST(EnvironmentRays, SeeABackgroundOrLightOrBoth) {
  const scene::Material matte = ShelteredFloor::matte(), mirror = testing::mirror();
  struct Case {
    RayKinds rays;
    double background, matte, mirror;
  };
  for (const Case& each :
       {Case{scene::kAllRays, 1.0, kLit, 0.9}, Case{kCamera, 1.0, 0.0, 0.0},
        Case{testing::all_but(kCamera), 0.0, kLit, 0.9}, Case{testing::all_but(kDiffuse), 1.0, 0.0, 0.9},
        Case{kDiffuse, 0.0, kLit, 0.0}, Case{kGlossy, 0.0, 0.0, 0.9}}) {
    SCOPED_TRACE(::testing::Message() << static_cast<int>(each.rays));
    EXPECT_NEAR(seen_in_environment(matte, each.rays, true), each.background, 1e-5);
    EXPECT_NEAR(seen_in_environment(matte, each.rays), each.matte, 1e-3);
    EXPECT_NEAR(seen_in_environment(mirror, each.rays), each.mirror, 1e-3);
  }
}

TEST(EnvironmentRays, OfVolumesLightFogOnly) {
  for (const RayKinds rays : {kVolume, testing::all_but(kVolume)}) {
    ShelteredFloor floor = foggy_floor();
    floor.hide_walls(scene::kAllRays);
    floor.scene().environment_rays = rays;
    expect_visible(floor.seen(), rays == kVolume ? 1.0 - kPassedBeyond : kPassedBeyond);
  }
}

TEST(EnvironmentRays, SeeTheSunToo) {
  for (const bool lights : {false, true}) {
    ShelteredFloor floor(ShelteredFloor::matte());
    floor.hide_walls(scene::kAllRays);
    floor.options.environment = {};
    floor.options.environment.sky = SkyOptions();
    floor.scene().environment_rays = lights ? scene::kAllRays : kCamera;
    EXPECT_EQ(floor.seen().mean() > 0.0, lights);
  }
}

TEST(HiddenFrom, SomeBouncesOnlyLeavesTheCache) {
  ShelteredFloor floor(ShelteredFloor::matte());
  floor.hide_walls(kGlossy);
  floor.options.integrator = Integrator::nrc;
  floor.options.spp = 4;
  Renderer renderer(floor.scene(), floor.options);
  tests::expect_messages(renderer.statistics().warnings, {{"built.glb", "cache", "`integrator` path"}});
  const Picture picture = renderer.render();
  RenderOptions saving = floor.options;
  saving.cache.cache_out = "/nowhere/cache";
  tests::expect_refused_parts<BadOption>([&] { Renderer(floor.scene(), saving); },
                                         {"integrator", "nrc", "cache", "path"});
  floor.options.integrator = Integrator::path;
  EXPECT_EQ(picture.layers[0].values, floor.picture().layers[0].values);
  floor.options.integrator = Integrator::nrc;
  floor.walls().visibility.rays = testing::all_but(kBounces);
  floor.options.cache.train_steps = 2;
  EXPECT_TRUE(Renderer(floor.scene(), floor.options).statistics().warnings.empty());
}

}  // namespace
}  // namespace gatelight::renderer
