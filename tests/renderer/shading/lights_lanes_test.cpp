// Every lane's light sample against Lights::sample with the same random numbers.

#include <algorithm>
#include <cmath>

#include "tests/renderer/shading/lanes.h"
#include "tests/support/light_scenes.h"

namespace gatelight::renderer {
namespace {

using namespace lanes;
using gatelight::testing::add_light;
using gatelight::testing::LitScene;
using gatelight::testing::quad;

scene::PunctualLight punctual(scene::LightType type, const Vec3& position, const Vec3& direction) {
  scene::PunctualLight light;
  light.type = type;
  light.position = position;
  light.direction = direction.normalized();
  light.intensity = Color(3.0f, 2.0f, 1.0f);
  light.cos_inner = 0.9f;
  light.cos_outer = 0.3f;
  light.range = type == scene::LightType::spot ? 30.0f : kInfinity;
  return light;
}

/// Triangles of all sizes around the origin, on both sides, some of them two-sided and some degenerate.
scene::Scene lamps(int count, Random& random) {
  scene::Scene scene;
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = random_direction(random);
    const float distance = 2.0f + 20.0f * random.uniform_float();
    const Vec3 at = distance * direction;
    const float size = std::pow(10.0f, 1.0f - 3.0f * random.uniform_float());
    gatelight::testing::Triangle t{at, at + size * random_direction(random),
                                   at + size * random_direction(random)};
    if (i % 17 == 5) t[2] = t[1];
    add_light(scene, {t}, Color(random.uniform_float() * 10.0f, 1.0f, 0.5f), i % 3 == 0);
  }
  return scene;
}

struct Agreement {
  int same = 0;
  int other = 0;         ///< another light, by a random number at the border between two
  int other_number = 0;  ///< in the same direction
  double worst = 0.0;
};

LightSample sample(const LitScene& lit, const LanePoint& p, bool delta) {
  const float choice = p.sampler.get_1d(p.dimensions + 2);
  const Vec2 point = p.sampler.get_2d(p.dimensions + 3);
  return delta ? lit.lights.sample_delta(p.surface.position, p.light_normal(), choice, point)
               : lit.lights.sample(p.surface.position, p.light_normal(), choice, point);
}

/// Compares lanes at random points. Where another light was chosen, the pdf must be that of this light.
/// delta: with Lights::sample_delta.
Agreement compare(const LitScene& lit, std::uint64_t seed, SamplerKind kind = SamplerKind::sobol,
                  bool delta = false) {
  Random random(seed);
  const LightArrays arrays(lit.lights);
  Agreement agreement;
  for (int i = 0; i < 1500; ++i) {
    ShadingBlock block = {};
    std::vector<LanePoint> points;
    for (int lane = 0; lane < ShadingBlock::kWidth; ++lane) {
      LanePoint p = random_point(random);
      if (random.uniform_float() < 0.5f) p.surface.material.transmission = 0.0f;
      p.sampler = Sampler::from_parts(kind, p.sampler.key(), p.sampler.index());
      points.push_back(p);
      put(block, p);
    }
    ShadingContext context = tables_only();
    context.lights = delta ? arrays.delta_view() : *arrays.view();
    run_all(block, context, &ShadingKernels::sample_lights);
    // The whole sampling also completes the lanes that the kernels leave open.
    const Shading shading = make_shading(lit.lights, arrays);
    SurfaceBlock surfaces{block, {}};
    delta ? shading.delta_light(surfaces) : shading.scatter(surfaces);
    const ShadingBlock& result = surfaces.points;
    for (int lane = 0; lane < block.count; ++lane) {
      const LightSample expected = sample(lit, points[lane], delta);
      const bool has = result.light_state[lane] == static_cast<std::uint32_t>(LaneLight::done) &&
                       result.light_pdf[lane] > 0.0f;
      const Vec3 wi = lane_vector(result.light_direction, lane);
      if (has != (expected.pdf > 0.0f) || (has && (wi - expected.wi).norm() > 2e-3f)) {
        ++agreement.other;
        continue;
      }
      ++agreement.same;
      if (!has) continue;
      const auto meet = [&](float a, float b) {
        if (a == b) return;
        const float difference = std::abs(a - b) / std::max(std::abs(a), std::abs(b));
        agreement.worst = std::max(agreement.worst, static_cast<double>(difference));
      };
      EXPECT_EQ(result.light_is_delta[lane] != 0, expected.delta);
      if (!delta && result.light[lane] != expected.light) ++agreement.other_number;
      meet(result.light_distance[lane], expected.distance);
      meet(result.light_pdf[lane], expected.pdf);
      meet(result.light_cosine[lane], expected.cosine);
      meet(result.light_offset[lane], expected.offset);
      for (int c = 0; c < 3; ++c) meet(result.light_radiance[c][lane], expected.radiance[c]);
    }
  }
  std::printf("%d lanes agree, %d chose another light, worst difference %.2e\n", agreement.same,
              agreement.other, agreement.worst);
  return agreement;
}

void expect_agreement(const Agreement& a, double worst = 5e-3) {
  EXPECT_GT(a.same, 1000);
  EXPECT_LT(a.other, 1e-3 * a.same);
  EXPECT_LT(a.other_number, 1e-3 * a.same);
  EXPECT_LT(a.worst, worst);
}

TEST(LightLanes, ALampIsSampledAsInTheScalarCode) {
  scene::Scene scene;
  add_light(scene, quad(Vec3(-1, 5, -1), Vec3(2, 0, 0), Vec3(0, 0, 2)), Color(1, 2, 3));
  expect_agreement(compare(LitScene(std::move(scene)), 1));
}

TEST(LightLanes, TheTreeChoosesAsInTheScalarCode) {
  Random random(2);
  for (const int count : {2, 3, 5, 16, 300, 5000}) {
    SCOPED_TRACE(count);
    expect_agreement(compare(LitScene(lamps(count, random)), 3));
  }
}

TEST(LightLanes, BothSamplersGiveTheSameNumbers) {
  Random random(4);
  expect_agreement(compare(LitScene(lamps(20, random)), 5, SamplerKind::independent));
}

TEST(LightLanes, PointsSpotsAndSunsAreSampledAsInTheScalarCode) {
  Random random(6);
  scene::Scene scene = lamps(6, random);
  scene.lights.push_back(punctual(scene::LightType::point, Vec3(5, 5, 5), Vec3(0, -1, 0)));
  scene.lights.push_back(punctual(scene::LightType::spot, Vec3(-6, 8, 0), Vec3(0.5f, -1, 0)));
  scene.lights.push_back(punctual(scene::LightType::directional, Vec3::Zero(), Vec3(0.2f, -1, 0.3f)));
  scene.lights.push_back(punctual(scene::LightType::directional, Vec3::Zero(), Vec3(-1, -0.1f, 0)));
  // Near the edge of a cone the difference of two cosines has few digits.
  constexpr double kWorst = 5e-2;
  expect_agreement(compare(LitScene(scene), 7), kWorst);
  expect_agreement(compare(LitScene(scene), 17, SamplerKind::sobol, true), kWorst);
  scene::Scene only;
  only.lights = scene.lights;
  expect_agreement(compare(LitScene(std::move(only)), 8), kWorst);
  scene::Scene suns;
  suns.lights = {scene.lights[2]};
  expect_agreement(compare(LitScene(suns), 9));
  expect_agreement(compare(LitScene(std::move(suns)), 18, SamplerKind::sobol, true));
}

/// Brightest at 60 degrees, with more light in x than in y, and none above.
std::shared_ptr<const scene::IesProfile> lopsided_profile() {
  return std::make_shared<const scene::IesProfile>(
      "TILT=NONE\n1 -1 1 3 2 1 2 0 0 0 1 1 1  0 60 90  0 90  10 80 30  10 40 5");
}

TEST(LightLanes, ProfilesAreThoseOfTheScalarCode) {
  Random random(21);
  scene::Scene scene = lamps(4, random);
  for (int i = 0; i < 4; ++i) {
    const Vec3 axis = random_direction(random), place = 9.0f * random_direction(random);
    scene::PunctualLight light =
        punctual(i % 2 == 0 ? scene::LightType::point : scene::LightType::spot, place, axis);
    if (i > 0) light.profile = lopsided_profile();
    if (i > 0) light.type = scene::LightType::point;
    light.side = any_perpendicular(light.direction);
    scene.lights.push_back(light);
  }
  expect_agreement(compare(LitScene(scene), 22));
  expect_agreement(compare(LitScene(std::move(scene)), 23, SamplerKind::sobol, true));
}

TEST(LightLanes, SkiesAreSampledAsInTheScalarCode) {
  EnvironmentOptions constant;
  constant.constant = Color(1, 2, 3);
  expect_agreement(compare(LitScene{scene::Scene()}, 15));  // no light at all
  expect_agreement(compare(LitScene({}, LightSelection::tree, constant), 10));
  Random random(11);
  expect_agreement(compare(LitScene(lamps(3, random), LightSelection::tree, constant), 12));
  const tests::TemporaryFolder folder;
  const EnvironmentOptions picture = gatelight::testing::uniform_picture(folder, 2.0f);
  expect_agreement(compare(LitScene({}, LightSelection::tree, picture), 13));
  scene::Scene scene = lamps(3, random);
  scene.lights.push_back(punctual(scene::LightType::directional, Vec3::Zero(), Vec3(0.2f, -1, 0.3f)));
  expect_agreement(compare(LitScene(std::move(scene), LightSelection::tree, picture), 14));
  for (const float size : {0.0f, 0.53f, 10.0f}) {
    SCOPED_TRACE(size);
    EnvironmentOptions clear;
    clear.sky = SkyOptions{.sun_size_degrees = size};
    expect_agreement(compare(LitScene({}, LightSelection::tree, clear), 19));
    expect_agreement(compare(LitScene(lamps(3, random), LightSelection::tree, clear), 20));
  }
}

TEST(LightLanes, SelectionByPowerUsesTheScalarCode) {
  Random random(16);
  scene::Scene scene = lamps(40, random);
  for (int i = 0; i < 3; ++i)
    scene.lights.push_back(
        punctual(scene::LightType::point, 6.0f * random_direction(random), Vec3(0, -1, 0)));
  const LitScene lit(std::move(scene), LightSelection::power);
  const LightArrays arrays(lit.lights);
  EXPECT_EQ(arrays.view(), nullptr);
  const Shading shading = make_shading(lit.lights, arrays);
  for (int b = 0; b < 200; ++b) {
    const bool delta = b % 2 == 1;
    SurfaceBlock surfaces = {};
    ShadingBlock& block = surfaces.points;
    std::vector<LanePoint> points;
    for (int lane = 0; lane < ShadingBlock::kWidth; ++lane) {
      points.push_back(random_point(random));
      put(block, points.back());
    }
    delta ? shading.delta_light(surfaces) : shading.scatter(surfaces);
    for (int lane = 0; lane < block.count; ++lane) {
      const LightSample expected = sample(lit, points[lane], delta);
      ASSERT_EQ(block.light_pdf[lane], expected.pdf);
      if (expected.pdf > 0.0f) {
        ASSERT_EQ(lane_vector(block.light_direction, lane), expected.wi);
        ASSERT_EQ(block.light[lane], expected.light);
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
