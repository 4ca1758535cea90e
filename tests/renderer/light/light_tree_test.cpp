#include "renderer/light/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/sampling/warp.h"
#include "tests/support/random_points.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

std::vector<LightBounds> scattered(int count, std::uint64_t seed, float size = 1.0f) {
  testing::Random random(seed);
  std::vector<LightBounds> lights;
  for (int i = 0; i < count; ++i) {
    LightBounds light;
    for (int axis = 0; axis < 3; ++axis) light.centre[axis] = size * (random.uniform_float() - 0.5f);
    light.axis = sample_uniform_sphere(testing::next_2d(random));
    light.radius = size * 0.01f * random.uniform_float();
    light.two_sided = i % 3 == 0;
    if (i % 7 == 0) light.cos_normals = -1.0f;
    if (i % 11 == 0) light.cos_emission = 0.7f;
    light.intensity = i % 13 == 5 ? 0.0 : std::exp(random.uniform(-3.0, 3.0));
    lights.push_back(light);
  }
  return lights;
}

LightTree::Choice choose(const LightTree& tree, const Vec3& p, const Vec3& n, double u) {
  const LightTree::Weights root = tree.weigh_root(p, n);
  return root.sum > 0.0f ? tree.sample(root, p, n, u) : LightTree::Choice{};
}

TEST(LightTreeTest, ChoicesFollowTheirProbabilities) {
  constexpr int kSamples = 50000;
  const std::vector<int> sizes{1, 2, 3, 4, 5, 16, 17, 300};
  for (const int size : sizes) {
    const std::vector<LightBounds> lights = scattered(size, static_cast<std::uint64_t>(size));
    const LightTree tree(lights);
    testing::Random random(9);
    for (const Vec3& n : {Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(-0.6f, 0, 0.8f)}) {
      const Vec3 p(0.3f, -0.2f, 0.4f);
      std::vector<double> expected;
      double sum = 0.0;
      for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const double probability = static_cast<double>(tree.probability(p, n, i));
        sum += probability;
        expected.push_back(kSamples * probability);
      }
      EXPECT_LE(sum, 1.0 + 1e-5);
      // The rest is no sample at all: a group that seemed to reach the point, and none of its lights does.
      expected.push_back(kSamples * (1.0 - sum > 1e-5 ? 1.0 - sum : 0.0));
      std::vector<double> observed(expected.size(), 0.0);
      for (int s = 0; s < kSamples; ++s) {
        const LightTree::Choice choice = choose(tree, p, n, random.uniform());
        if (!(choice.probability > 0.0f)) {
          observed.back() += 1.0;
          continue;
        }
        ASSERT_NEAR(choice.probability / tree.probability(p, n, choice.light), 1.0f, 1e-4f);
        observed[choice.light] += 1.0;
      }
      EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                                   testing::sidak(testing::kFamilySignificance, 3 * sizes.size())))
          << size << " lights";
    }
  }
}

TEST(LightTreeTest, ProbabilitiesSumUpToOneWhereEveryLightReaches) {
  std::vector<LightBounds> lights = scattered(1000, 4);
  for (LightBounds& light : lights) light.cos_normals = -1.0f;
  const LightTree tree(lights);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(-0.4f, 0.4f, 0.1f), Vec3(1e4f, 1e4f, 0)}) {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      sum += static_cast<double>(tree.probability(p, Vec3::Zero(), i));
    }
    EXPECT_NEAR(sum, 1.0, 1e-4);
  }
}

// Selection by the tree is unbiased: a light with a part that shines towards the receiver and stands above
// its horizon has a nonzero probability.
TEST(LightTreeTest, EveryLightThatShinesOnThePointCanBeChosen) {
  testing::Random random(5);
  for (const float size : {1e-3f, 1.0f, 1e6f}) {
    const std::vector<LightBounds> lights = scattered(500, 6, size);
    const LightTree tree(lights);
    for (int trial = 0; trial < 200; ++trial) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = 2.0f * size * (random.uniform_float() - 0.5f);
      const Vec3 n = sample_uniform_sphere(testing::next_2d(random));
      for (std::uint32_t i = 0; i < lights.size(); ++i) {
        const LightBounds& light = lights[i];
        const float probability = tree.probability(p, n, i);
        ASSERT_TRUE(std::isfinite(probability) && probability >= 0.0f && probability <= 1.0001f);
        const Vec3 to = (light.centre - p).normalized();
        const float along = -to.dot(light.axis);
        const float cosine = light.cos_normals < 0.0f ? 1.0f : light.two_sided ? std::abs(along) : along;
        if (light.intensity > 0.0 && to.dot(n) > 1e-3f && cosine > light.cos_emission + 1e-3f) {
          ASSERT_GT(probability, 0.0f) << "light " << i << " size " << size;
        }
        if (!(light.intensity > 0.0)) {
          ASSERT_EQ(probability, 0.0f);
        }
      }
    }
  }
}

TEST(LightTreeTest, PrefersTheNearTheBrightAndTheFacing) {
  LightBounds light;
  light.centre = Vec3(0, 1, 0);
  light.axis = Vec3(0, -1, 0);
  light.radius = 0.01f;
  light.intensity = 1.0;
  std::vector<LightBounds> lights(2, light);
  lights[1].centre = Vec3(0, 2, 0);
  EXPECT_NEAR(LightTree(lights).probability(Vec3::Zero(), Vec3::UnitY(), 0), 0.8f, 1e-3f);
  lights[1] = light;
  lights[1].intensity = 3.0;
  EXPECT_NEAR(LightTree(lights).probability(Vec3::Zero(), Vec3::UnitY(), 0), 0.25f, 1e-3f);
  lights[1] = light;
  lights[1].axis = Vec3(0, 1, 0);
  EXPECT_NEAR(LightTree(lights).probability(Vec3::Zero(), Vec3::UnitY(), 0), 1.0f, 1e-3f);
  lights[1].two_sided = true;
  EXPECT_NEAR(LightTree(lights).probability(Vec3::Zero(), Vec3::UnitY(), 0), 0.5f, 1e-3f);
}

/// Second moment of a sample's light over the squared mean, 1 at best: the noise from the choice of a light.
/// Mean over some points among the lights.
double cost_of_choices(const std::vector<LightBounds>& lights) {
  const LightTree tree(lights);
  testing::Random random(31);
  double cost = 0.0;
  constexpr int kPoints = 50;
  for (int i = 0; i < kPoints; ++i) {
    Vec3 p;  // one number a statement: compilers evaluate arguments in orders of their own
    for (const int axis : {2, 1, 0}) p[axis] = random.uniform_float() - 0.5f;
    double mean = 0.0;
    double second = 0.0;
    for (std::uint32_t k = 0; k < lights.size(); ++k) {
      const LightBounds& light = lights[k];
      const Vec3 to = light.centre - p;
      const float along = -to.normalized().dot(light.axis);
      const float cosine = light.cos_normals < 0.0f ? 1.0f : std::max(along, 0.0f);
      const double sent = light.intensity * static_cast<double>(cosine / to.squaredNorm());
      mean += sent;
      if (sent > 0.0) second += sent * sent / static_cast<double>(tree.probability(p, Vec3::Zero(), k));
    }
    cost += second / (mean * mean) / kPoints;
  }
  return cost;
}

TEST(LightTreeTest, SplitsLightsByPositionAndDirection) {
  // Shuffled: groups in the order of the list would cover the whole cube. Measured 2.08 (4.5 in such
  // groups) and 4.64.
  std::vector<LightBounds> lights = scattered(800, 17);
  for (LightBounds& light : lights) {
    light = {.centre = light.centre, .radius = 1e-3f, .axis = light.axis, .intensity = 1.0};
    light.cos_normals = -1.0f;
  }
  EXPECT_LT(cost_of_choices(lights), 2.4) << "lamps that shine all round";
  for (LightBounds& light : lights) {
    light.cos_normals = 1.0f;
    light.axis = light.axis.x() > 0.0f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  }
  EXPECT_LT(cost_of_choices(lights), 5.2) << "panels that face one of two ways";
}

TEST(LightTreeTest, SurvivesEqualAndExtremeLights) {
  LightBounds light;
  light.intensity = 1e-20;
  std::vector<LightBounds> lights(1000, light);
  lights[3].intensity = 1e20;
  for (std::size_t i = 500; i < 1000; ++i) lights[i].centre.x() = std::exp2(static_cast<float>(i % 100));
  const LightTree tree(lights);
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0, 0, 1e-20f), Vec3(0, 0, 1e10f)}) {
    for (const double u : {0.0, 0.5, 0x1.fffffffffffffp-1}) {
      const LightTree::Choice choice = choose(tree, p, Vec3::Zero(), u);
      EXPECT_TRUE(std::isfinite(choice.probability));
    }
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      EXPECT_TRUE(std::isfinite(tree.probability(p, Vec3::Zero(), i)));
    }
  }
  EXPECT_TRUE(LightTree(std::vector<LightBounds>(3)).empty());
  EXPECT_TRUE(LightTree(std::vector<LightBounds>{}).empty());
}

}  // namespace
}  // namespace gatelight::renderer
