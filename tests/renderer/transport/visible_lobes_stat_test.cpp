// Lamps that rays of some lobes do not see: the light of the others stays, however it is sampled.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/render.h"
#include "tests/support/light_scenes.h"
#include "tests/support/sheltered_floor.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using scene::RayKinds;
using testing::Moments;
using testing::SceneBuilder;
using testing::ShelteredFloor;

constexpr DirectLight kAllDirect[] = {DirectLight::mis, DirectLight::nee, DirectLight::bsdf};
const double kLobesSignificance = testing::sidak(1e-4, 6);

/// A floor below a lamp of radiance 5 that these rays see.
struct UnderLamp : ShelteredFloor {
  UnderLamp(const scene::Material& floor, RayKinds rays, bool from_below = false) : ShelteredFloor(floor) {
    const float y = from_below ? -1.0f : 1.0f;
    const Vec3 right(2, 0, 0), back(0, 0, 2);
    quad(material(lambert(Color::Zero(), Color::Constant(5.0f))), Vec3(-0.7f, y, -1),
         from_below ? back : right, from_below ? right : back);
    scene().instances.back().visibility.rays = rays;
    options.environment = {};
    options.spp = 16;
  }
  double irradiance() {
    const std::vector<testing::Triangle> lamp =
        testing::quad(Vec3(-0.7f, 1, -1), Vec3(2, 0, 0), Vec3(0, 0, 2));
    return 5.0 * testing::triangles_irradiance(lamp, Vec3::Zero(), Vec3::UnitY());
  }
};

TEST(HiddenLamps, LightLikeVisibleOnes) {
  for (const RayKinds rays :
       {testing::all_but(scene::kCameraRays), testing::all_but(scene::kCameraRays | scene::kGlossyRays)}) {
    for (const DirectLight direct : kAllDirect) {
      UnderLamp under(ShelteredFloor::matte(), rays);
      under.options.direct = direct;
      under.options.spp = 256;
      const Moments seen = under.seen();  // through the lamp
      const double expected = static_cast<double>(ShelteredFloor::kAlbedo) / M_PI * under.irradiance();
      EXPECT_GT(testing::mean_p_value(seen, expected, 1e-3), kLobesSignificance)
          << static_cast<int>(direct) << ": " << seen.mean() << ", expected " << expected;
    }
  }
}

TEST(HiddenLamps, OfDiffuseRaysDoNotLightAFloor) {
  for (const DirectLight direct : kAllDirect) {
    for (const RayKinds hidden : {scene::kDiffuseRays, scene::kBounceRays}) {
      UnderLamp under(ShelteredFloor::matte(),
                      testing::all_but(hidden | scene::kCameraRays | scene::kShadowRays));
      under.options.direct = direct;
      EXPECT_EQ(under.seen().mean(), 0.0);
    }
  }
}

TEST(HiddenLamps, OfPointsKeepTheOtherLobes) {
  for (const RayKinds hidden : {scene::kDiffuseRays, scene::kGlossyRays}) {
    ShelteredFloor floor(ShelteredFloor::matte());
    floor.options.environment = {};
    floor.scene().lights = {testing::point_light(Vec3(0, 2, 0), Color::Ones())};
    floor.scene().lights[0].rays = testing::all_but(hidden);
    const double expected = static_cast<double>(ShelteredFloor::kAlbedo) / M_PI / 4.0;
    EXPECT_NEAR(floor.seen().mean(), hidden == scene::kDiffuseRays ? 0.0 : expected, 1e-4);
  }
}

/// The means of pictures with the seeds 1 to kSeeds of a floor under a lamp that some rays do not see: the
/// sum over these rays.
Moments means_of_lobes(const scene::Material& floor, const std::vector<RayKinds>& hidden, DirectLight direct,
                       bool from_below = false) {
  Moments sums;
  for (std::uint32_t seed = 1; seed <= testing::kSeeds; ++seed) {
    double sum = 0.0;
    for (const RayKinds from : hidden) {
      UnderLamp under(floor, testing::all_but(from | scene::kCameraRays), from_below);
      under.options.direct = direct;
      under.options.seed = seed;
      under.options.camera.look_at->eye = Vec3(1.2f, 2, 0.3f);
      sum += under.seen().mean();
    }
    sums.add(sum);
  }
  return sums;
}

TEST(Lobes, OfPlasticAddUp) {
  scene::Material plastic;
  plastic.base_color = Color::Constant(0.5f);
  plastic.metallic = 0.0f;
  plastic.roughness = 0.35f;
  scene::Material varnish = plastic;
  varnish.roughness = 0.8f;
  varnish.clearcoat = 1.0f;
  varnish.clearcoat_roughness = 0.3f;
  for (const scene::Material& material : {plastic, varnish}) {
    const Moments glossy = means_of_lobes(material, {scene::kDiffuseRays}, DirectLight::mis);
    const Moments both = means_of_lobes(material, {0}, DirectLight::mis);
    EXPECT_GT(glossy.mean(), 0.05 * both.mean());
    EXPECT_LT(glossy.mean(), 0.95 * both.mean());
    for (const DirectLight direct : kAllDirect) {
      SCOPED_TRACE(static_cast<int>(direct));
      testing::expect_equal_means(means_of_lobes(material, {scene::kGlossyRays, scene::kDiffuseRays}, direct),
                                  both);
    }
  }
}

TEST(Lobes, OfMetalAreGlossy) {
  scene::Material metal;
  metal.base_color = Color::Constant(0.8f);
  metal.roughness = 0.5f;
  const Moments all = means_of_lobes(metal, {0}, DirectLight::mis);
  for (const DirectLight direct : kAllDirect) {
    EXPECT_EQ(means_of_lobes(metal, {scene::kGlossyRays}, direct).mean(), 0.0);
    testing::expect_equal_means(
        means_of_lobes(metal, {scene::kDiffuseRays | scene::kTransmissionRays}, direct), all);
  }
}

TEST(Lobes, OfALeafLitFromBehindTransmit) {
  scene::Material leaf = SceneBuilder::lambert(Color::Constant(0.8f));
  leaf.diffuse_transmission = 0.7f;
  leaf.double_sided = true;
  const Moments all = means_of_lobes(leaf, {0}, DirectLight::mis, true);
  EXPECT_GT(all.mean(), 0.0);
  for (const DirectLight direct : kAllDirect) {
    EXPECT_EQ(means_of_lobes(leaf, {scene::kTransmissionRays}, direct, true).mean(), 0.0);
    testing::expect_equal_means(
        means_of_lobes(leaf, {scene::kDiffuseRays | scene::kGlossyRays}, direct, true), all);
  }
}

}  // namespace
}  // namespace gatelight::renderer
