// Different ways to estimate the same picture agree: next-event estimation, BSDF sampling and their
// combinations, both heuristics, both ways to choose a light, both samplers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {

namespace {

using testing::Moments;
using testing::SceneBuilder;

constexpr int kWidth = 32;
constexpr int kHeight = 24;
constexpr int kBlock = 8;

/// Glossy and matte things under a large dim light, a small bright one, forty tiny coloured lights, a point
/// light and a dim sky.
SceneBuilder glossy_scene() {
  SceneBuilder builder;
  scene::Material floor;
  floor.base_color = Color(0.9f, 0.8f, 0.7f);
  floor.roughness = 0.35f;
  testing::add_floor(builder, floor, 3);
  scene::Material plastic;
  plastic.base_color = Color(0.2f, 0.3f, 0.6f);
  plastic.metallic = 0.0f;
  plastic.roughness = 0.4f;
  builder.sphere(builder.material(plastic), Vec3(-0.8f, 0.6f, 0), 0.6f, 32, true);
  const int matte = builder.material(SceneBuilder::lambert(Color(0.6f, 0.6f, 0.6f)));
  builder.box(matte, Vec3(0.4f, 0.001f, -0.5f), Vec3(1.2f, 0.9f, 0.3f));
  const auto lamp = [&](const Color& radiance) {
    return builder.material(SceneBuilder::lambert(Color::Zero(), radiance));
  };
  builder.quad(lamp(Color::Constant(0.8f)), Vec3(-2, 3, -2), Vec3(4, 0, 0), Vec3(0, 0, 3));
  builder.quad(lamp(Color(30.0f, 20.0f, 10.0f)), Vec3(-0.2f, 1.9f, 0.6f), Vec3(0.3f, 0, 0), Vec3(0, 0, 0.3f));
  const int crumb = lamp(Color(1.0f, 4.0f, 2.0f));
  for (int i = 0; i < 40; ++i) {
    const float a = 0.157f * static_cast<float>(i);
    const Vec3 p(2.0f * std::cos(a), 0.3f + 0.02f * static_cast<float>(i), 2.0f * std::sin(a) - 0.5f);
    builder.box(crumb, p, p + Vec3::Constant(0.08f));
  }
  builder.scene().lights = {testing::point_light(Vec3(1.5f, 2.0f, 1.5f), Color(0.6f, 0.6f, 1.2f))};
  return builder;
}

RenderOptions base_options() {
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.spp = 768;
  options.max_depth = 4;
  options.sampler = SamplerKind::independent;
  options.aovs = {Aov::variance};
  options.environment.constant = Color(0.05f, 0.08f, 0.12f);
  LookAt view;
  view.eye = Vec3(0, 1.8f, 4.0f);
  view.target = Vec3(0, 0.5f, 0);
  options.camera.look_at = view;
  options.camera.fov_degrees = 40.0f;
  return options;
}

struct Estimate {
  double mean = 0.0;
  double variance = 0.0;  ///< of the mean
};

/// Means of blocks of 8x8 pixels, channel after channel, and as the last three those of the picture. Pixels
/// are independent, so their variances add.
std::vector<Estimate> block_means(const Picture& picture) {
  const int columns = kWidth / kBlock;
  const std::size_t blocks = static_cast<std::size_t>(columns * (kHeight / kBlock));
  std::vector<Estimate> estimates(3 * (blocks + 1));
  const std::vector<float>& values = picture.layers[0].values;
  const std::vector<float>& variances = picture.find("variance")->values;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t i = static_cast<std::size_t>(3 * (y * kWidth + x)) + c;
        const std::size_t block = static_cast<std::size_t>(y / kBlock * columns + x / kBlock);
        for (const std::size_t of : {block, blocks}) {
          const double n = of == block ? kBlock * kBlock : kWidth * kHeight;
          estimates[3 * of + c].mean += values[i] / n;
          estimates[3 * of + c].variance += variances[i] / (n * n);
        }
      }
    }
  }
  return estimates;
}

void expect_agreement(const std::vector<Estimate>& a, const std::vector<Estimate>& b,
                      double degrees_of_freedom) {
  // Seven comparisons in this file.
  const double limit = testing::sidak(1e-5, 7 * a.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double score = (a[i].mean - b[i].mean) / std::sqrt(a[i].variance + b[i].variance);
    squares += score * score;
    EXPECT_GT(testing::student_two_sided(score, degrees_of_freedom), limit)
        << (i + 3 < a.size() ? "block " : "picture, ") << i / 3 << ", channel " << i % 3 << ": " << a[i].mean
        << " and " << b[i].mean << ", score " << score;
  }
  ::testing::Test::RecordProperty("mean_square_score",
                                  std::to_string(squares / static_cast<double>(a.size())));
}

std::vector<Estimate> render(const RenderOptions& options) {
  SceneBuilder builder = glossy_scene();
  return block_means(Renderer(builder.scene(), options).render());
}

/// Blocks have many samples, so that their means are nearly normal.
constexpr double kManySamples = 1e4;

class Estimators : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { reference_ = new std::vector<Estimate>(render(reference_options())); }
  static RenderOptions reference_options() {
    RenderOptions options = base_options();
    options.spp *= 2;
    return options;
  }
  static void TearDownTestSuite() { delete reference_; }

  static std::vector<Estimate>* reference_;
};
std::vector<Estimate>* Estimators::reference_ = nullptr;

TEST_F(Estimators, EveryWayToSampleAgrees) {
  struct Way {
    const char* name;
    std::function<void(RenderOptions&)> choose;
  };
  const Way ways[] = {
      {"next-event estimation without MIS", [](RenderOptions& o) { o.direct = DirectLight::nee; }},
      {"BSDF sampling without MIS", [](RenderOptions& o) { o.direct = DirectLight::bsdf; }},
      {"balance heuristic", [](RenderOptions& o) { o.mis = MisHeuristic::balance; }},
      {"lights by power", [](RenderOptions& o) { o.light_selection = LightSelection::power; }},
      {"lights by power without MIS",
       [](RenderOptions& o) {
         o.light_selection = LightSelection::power;
         o.direct = DirectLight::nee;
       }},
      {"early roulette", [](RenderOptions& o) { o.min_depth = 1; }}};
  RenderOptions options = base_options();
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    RenderOptions chosen = options;
    way.choose(chosen);
    chosen.seed = ++options.seed;
    expect_agreement(render(chosen), *reference_, kManySamples);
  }
}

TEST_F(Estimators, SobolAndIndependentSamplesAgree) {
  // The variance layer is only a bound for Sobol samples, so the variance is that over seeds.
  constexpr std::uint32_t kSobolSeeds = 16;
  RenderOptions options = base_options();
  options.sampler = SamplerKind::sobol;
  options.spp = 32;
  std::vector<Moments> moments(reference_->size());
  for (std::uint32_t seed = 0; seed < kSobolSeeds; ++seed) {
    options.seed = 100 + seed;
    const std::vector<Estimate> one = render(options);
    for (std::size_t i = 0; i < one.size(); ++i) moments[i].add(one[i].mean);
  }
  std::vector<Estimate> sobol;
  for (const Moments& m : moments) {
    sobol.push_back({m.mean(), m.standard_error() * m.standard_error()});
  }
  expect_agreement(sobol, *reference_, kSobolSeeds - 1);
}

TEST_F(Estimators, TwoPercentMoreLightIsDetected) {
  RenderOptions options = base_options();
  options.seed = 7;
  std::vector<Estimate> brighter = render(options);
  double score = 0.0;
  for (std::size_t i = 0; i < brighter.size(); ++i) {
    const double error = std::sqrt(brighter[i].variance + (*reference_)[i].variance);
    score = std::max(score, 0.02 * brighter[i].mean / error);
  }
  EXPECT_LT(testing::student_two_sided(score, kManySamples), testing::sidak(1e-5, 7 * brighter.size()));
}

}  // namespace
}  // namespace gatelight::renderer
