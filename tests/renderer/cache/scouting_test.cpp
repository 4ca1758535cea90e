// The results of scouting: the sides that paths meet, the brightness and the extent of the scene.

#include "renderer/cache/scouting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/cache/small_worlds.h"

namespace gatelight::renderer {
namespace {

using neural::Sides;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

RenderOptions by(Integrator integrator) {
  RenderOptions options;
  options.integrator = integrator;
  return options;
}

ScoutReport scouted(const ViewedWorld& viewed, const RenderOptions& options) {
  Scouting scouting;
  scouting.add(viewed.world, viewed.camera, viewed.region, options);
  return scouting.report(viewed.world.scene, options);
}

/// A double-sided room, seen from inside, with a double-sided card that stands free, a double-sided block
/// that is seen from outside, a mirrored single-sided copy of the card, and a thing behind the walls.
SceneBuilder rooms() {
  SceneBuilder builder;
  scene::Material both = SceneBuilder::lambert(Color::Constant(0.5f), Color::Constant(1.0f));
  both.double_sided = true;
  const int twofold = builder.material(both);
  const int single = builder.material(SceneBuilder::lambert(Color::Constant(0.4f)));
  builder.box(twofold, Vec3(-2, -1, -3), Vec3(2, 2, 3), true);
  builder.quad(twofold, Vec3(-1.5f, -0.5f, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  builder.box(twofold, Vec3(0.5f, -0.9f, -1), Vec3(1.2f, 0, -0.3f));
  builder.quad(single, Vec3(-0.4f, -0.5f, -0.5f), Vec3(-1, 0, 0), Vec3(0, 1, 0));
  scene::Instance& mirrored = builder.scene().instances.back();
  mirrored.baked = false;
  mirrored.swaps_handedness = true;
  mirrored.transform.scale(Vec3(-1, 1, 1));
  builder.box(twofold, Vec3(5, 0, 0), Vec3(6, 1, 1));
  builder.scene().cameras.push_back(view_from(Vec3(0.3f, 0.5f, 2.5f), Vec3::Zero()));
  return builder;
}

const std::vector<Sides>& expected_sides() {
  // The room has its fronts, which look inwards; the mirrored card has its front, which by its corners is the
  // back.
  static const std::vector<Sides> sides{Sides::front, Sides::both, Sides::front, Sides::back, Sides::none};
  return sides;
}

TEST(Scouting, SidesAreStoredWhereTheyAreMet) {
  const ViewedWorld viewed(rooms());
  const ScoutReport report = scouted(viewed, by(Integrator::nrc));
  EXPECT_EQ(report.setup.sides, expected_sides());
  EXPECT_GT(report.rays.camera, 0u);
  EXPECT_GT(report.rays.bounce, 0u);
}

TEST(Scouting, ForOcclusionOnlySidesVisibleToTheCameraAreStored) {
  const ViewedWorld viewed(rooms());
  const ScoutReport report = scouted(viewed, by(Integrator::nao));
  EXPECT_EQ(report.setup.sides,
            (std::vector<Sides>{Sides::front, Sides::front, Sides::front, Sides::back, Sides::none}));
  EXPECT_EQ(report.setup.target_scale, 1.0f);
  EXPECT_FLOAT_EQ(report.setup.records_per_path, 1.0f);
}

TEST(Scouting, WithoutScoutingAllSidesThatMaterialsShowAreStored) {
  const ViewedWorld viewed(rooms());
  RenderOptions options = by(Integrator::nrc);
  options.cache.scout = false;
  EXPECT_EQ(scouted(viewed, options).setup.sides,
            (std::vector<Sides>{Sides::both, Sides::both, Sides::both, Sides::back, Sides::both}));
}

TEST(Scouting, ABackThatIsMetIsStoredAsItsFront) {
  SceneBuilder builder;
  builder.box(builder.material(SceneBuilder::lambert(Color::Constant(0.5f), Color::Constant(1.0f))),
              Vec3(-2, -1, -3), Vec3(2, 2, 3));  // fronts outwards, seen from inside
  builder.scene().cameras.push_back(view_from(Vec3(0.3f, 0.5f, 2.5f), Vec3::Zero()));
  const ViewedWorld viewed(builder);
  EXPECT_EQ(scouted(viewed, by(Integrator::nrc)).setup.sides, std::vector<Sides>{Sides::front});
}

TEST(Scouting, TargetsAreScaledToAMeanOfOne) {
  for (const float brightness : {1e4f, 1e-6f}) {
    const ViewedWorld viewed(testing::closed_furnace(0.5f, brightness));
    RenderOptions options = by(Integrator::nrc);
    options.max_depth = 64;
    // Every target's mean is Le / (1 - a).
    const ScoutReport report = scouted(viewed, options);
    EXPECT_NEAR(report.setup.target_scale * 2.0f * brightness, 1.0f, 0.01f);
    options.cache.component = CachedComponent::indirect;
    EXPECT_NEAR(scouted(viewed, options).setup.target_scale * brightness, 1.0f, 0.01f);
  }
}

TEST(Scouting, TheNumberOfRecordsIsPredicted) {
  const ViewedWorld viewed(testing::closed_furnace(0.5f, 1.0f));
  RenderOptions options = by(Integrator::nrc);
  options.min_depth = 64;
  options.max_depth = 10;
  options.cache.self_training.vertices = 3;
  options.cache.self_training.full_fraction = 0.25f;
  const ScoutReport report = scouted(viewed, options);
  // Roulette ends a path at the depth at which it begins, where the throughput is 2^-64. The depth of the
  // picture does not end it.
  EXPECT_FLOAT_EQ(report.setup.records_per_path, 64.0f);
  EXPECT_FLOAT_EQ(report.setup.records_per_short_path, 0.25f * 64.0f + 0.75f * 3.0f);
  options.cache.path_length = 4;
  EXPECT_FLOAT_EQ(scouted(viewed, options).setup.records_per_path, 1.0f);
}

TEST(Scouting, AGivenSpacingIsKept) {
  const ViewedWorld viewed(rooms());
  RenderOptions options = by(Integrator::nrc);
  options.cache.node_spacing = 0.37f;
  const CacheSetup setup = scouted(viewed, options).setup;
  EXPECT_EQ(setup.node_spacing, 0.37f);
  EXPECT_EQ(setup.spacing_scales, std::vector<float>(setup.sides.size(), 1.0f)) << "everywhere";
}

TEST(Scouting, NodesOfOcclusionLieTwiceAsClose) {
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(-9, -9, 0),
               Vec3(18, 0, 0), Vec3(0, 18, 0));
  builder.scene().cameras.push_back(view_from(Vec3(0, 0, 5), Vec3::Zero()));
  const ViewedWorld viewed(builder, {.constant = Color::Ones()});
  RenderOptions options = by(Integrator::nrc);
  options.width = viewed.region.width();
  options.height = viewed.region.height();
  const float of_radiance = scouted(viewed, options).setup.node_spacing;
  options.integrator = Integrator::nao;
  EXPECT_NEAR(scouted(viewed, options).setup.node_spacing, 0.5f * of_radiance, 0.02f * of_radiance);
}

TEST(Scouting, NodesLieCloserNearTheCamera) {
  SceneBuilder builder;
  const int grey = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.box(grey, Vec3(-50, -50, -50), Vec3(50, 50, 50), true);
  builder.box(grey, Vec3(-0.1f, -0.1f, -0.1f), Vec3(0.1f, 0.1f, 0.1f));
  builder.box(grey, Vec3(-0.1f, -0.1f, 3.0f), Vec3(0.1f, 0.1f, 3.2f));  // behind the camera
  builder.scene().cameras.push_back(view_from(Vec3(0, 0.2f, 1), Vec3::Zero()));
  const ViewedWorld viewed(builder, {.constant = Color::Ones()});
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
    RenderOptions options = by(integrator);
    options.width = viewed.region.width();
    options.height = viewed.region.height();
    const CacheSetup setup = scouted(viewed, options).setup;
    ASSERT_EQ(setup.spacing_scales.size(), 3u);
    EXPECT_EQ(setup.spacing_scales[0], 1.0f) << "most of the picture";
    EXPECT_LE(setup.spacing_scales[1], 0x1p-5f) << "a metre away instead of fifty or so";
    EXPECT_GT(setup.node_spacing, 0.5f);
    EXPECT_LT(setup.node_spacing, 10.0f);
  }
}

TEST(Scouting, OptionsOfTrainingPointsDoNotMatter) {
  const ViewedWorld viewed(rooms());
  RenderOptions options = by(Integrator::nrc);
  const CacheSetup plain = scouted(viewed, options).setup;
  options.cache.candidates = 16;
  options.cache.samples_per_point = 4;
  options.cache.source = TrainingSource::surface;
  const CacheSetup other = scouted(viewed, options).setup;
  EXPECT_EQ(plain.sides, other.sides);
  EXPECT_EQ(plain.node_spacing, other.node_spacing);
  EXPECT_EQ(plain.spacing_scales, other.spacing_scales);
  EXPECT_EQ(plain.target_scale, other.target_scale);
}

TEST(Scouting, ScenesWithoutVisibleSurfacesHaveAValidSetup) {
  const auto check = [](const SceneBuilder& builder, Sides expected) {
    const ViewedWorld viewed(builder, {.constant = Color::Ones()});
    for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
      const CacheSetup setup = scouted(viewed, by(integrator)).setup;
      for (const Sides s : setup.sides) EXPECT_EQ(s, expected);
      for (const float f :
           {setup.node_spacing, setup.target_scale, setup.records_per_path, setup.records_per_short_path}) {
        EXPECT_TRUE(std::isfinite(f));
        EXPECT_GT(f, 0.0f);
      }
    }
  };
  SceneBuilder empty;
  empty.scene().cameras.push_back(view_from(Vec3(0, 0, 5), Vec3::Zero()));
  check(empty, Sides::none);
  SceneBuilder behind;
  behind.quad(behind.material(SceneBuilder::lambert(Color::Constant(0.5f))), Vec3(0, 0, 9), Vec3(1, 0, 0),
              Vec3(0, 1, 0));
  behind.scene().cameras.push_back(view_from(Vec3(0, 0, 5), Vec3::Zero()));
  check(behind, Sides::none);
}

}  // namespace
}  // namespace gatelight::renderer
