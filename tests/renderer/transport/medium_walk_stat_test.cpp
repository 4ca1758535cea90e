// Media that scatter: their phase function, the distances between events, and closed forms of whole walks.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "renderer/medium/phase.h"
#include "renderer/medium/scattering_medium.h"
#include "renderer/render.h"
#include "renderer/transport/medium_walk.h"
#include "tests/support/picture_moments.h"
#include "tests/support/scene_builder.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::kFamilySignificance;
using testing::mean_p_value;
using testing::Moments;
using testing::SceneBuilder;

constexpr std::array kAnisotropies = {-0.99f, -0.6f, 0.0f, 5e-4f, 0.3f, 0.9f, 0.99f};
constexpr double kSignificance = 1e-6;

class Random {
 public:
  float operator()() { return sampling::to_unit_float(engine_()); }
  Vec2 pair() { return {(*this)(), (*this)()}; }

 private:
  std::mt19937 engine_{7};
};

TEST(Phase, SamplesFollowTheDensity) {
  constexpr int kBins = 64, kSamples = 200000;
  Random random;
  const Vec3 direction = Vec3(0.3f, -0.5f, 0.8f).normalized();
  for (const float g : kAnisotropies) {
    // The distribution function of the cosine has a closed form.
    const auto below = [&](double c) {
      const double h = static_cast<double>(g);
      if (std::abs(h) < 1e-3) return 0.5 * (c + 1.0) + 0.75 * h * (c * c - 1.0);
      return (1.0 - h * h) / (2.0 * h) * (1.0 / std::sqrt(1.0 + h * h - 2.0 * h * c) - 1.0 / (1.0 + h));
    };
    std::vector<double> observed(kBins, 0.0), expected(kBins);
    std::vector<double> around(16, 0.0);
    const Vec3 x = any_perpendicular(direction), y = direction.cross(x);
    Moments cosines;
    for (int i = 0; i < kSamples; ++i) {
      const Vec3 wi = sample_phase(g, direction, random.pair());
      const double c = std::clamp(static_cast<double>(wi.dot(direction)), -1.0, 1.0);
      cosines.add(c);
      observed[std::min(static_cast<std::size_t>((c + 1.0) / 2.0 * kBins), observed.size() - 1)] += 1.0;
      const double angle = std::atan2(static_cast<double>(wi.dot(y)), static_cast<double>(wi.dot(x)));
      around[std::min(static_cast<std::size_t>((angle / (2.0 * M_PI) + 0.5) * 16.0), around.size() - 1)] +=
          1.0;
    }
    for (int b = 0; b < kBins; ++b)
      expected[static_cast<std::size_t>(b)] =
          kSamples * (below(-1.0 + 2.0 * (b + 1) / kBins) - below(-1.0 + 2.0 * b / kBins));
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected), kSignificance)) << g;
    EXPECT_TRUE(testing::accepts(testing::chi_square_test(around, std::vector<double>(16, kSamples / 16.0)),
                                 kSignificance))
        << g;
    EXPECT_GT(mean_p_value(cosines, static_cast<double>(g), 1e-4), kSignificance) << g;
    // The density itself: over its range it integrates to the bins.
    const auto density = [&](double c) {
      return 2.0 * M_PI * static_cast<double>(phase(g, static_cast<float>(c)));
    };
    EXPECT_NEAR(testing::integrate(density, -0.5, 0.5, 64), below(0.5) - below(-0.5), 2e-5) << g;
  }
}

/// Distances are sampled by a random channel, and yet each channel has its own transmittance and events.
TEST(Flight, IsUnbiasedForEachChannel) {
  const ScatteringMedium medium{.extinction = Color(0.2f, 1.0f, 5.0f), .albedo = Color(0.9f, 0.5f, 1.0f)};
  Random random;
  for (const Color& throughput : {Color(1, 1, 1), Color(0.1f, 0.6f, 0.02f), Color(0, 1, 0)}) {
    for (const float end : {0.1f, 1.0f, 4.0f}) {
      std::array<Moments, 3> passed, scattered;
      for (int i = 0; i < 100000; ++i) {
        const ChannelChoice choice(medium, throughput, random());
        const float distance = sample_distance(medium, choice, random());
        const bool event = distance < end;
        const Color weight = flight_weight(medium, choice, event ? distance : end, event) * throughput;
        for (std::size_t c = 0; c < 3; ++c) {
          const auto value = static_cast<double>(weight[static_cast<Eigen::Index>(c)]);
          passed[c].add(event ? 0.0 : value);
          scattered[c].add(event ? value : 0.0);
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const auto i = static_cast<Eigen::Index>(c);
        const auto light = static_cast<double>(throughput[i]);
        const double left = std::exp(-static_cast<double>(medium.extinction[i] * end));
        EXPECT_GT(mean_p_value(passed[c], light * left), kSignificance) << c << " " << end;
        EXPECT_GT(mean_p_value(scattered[c], light * (1.0 - left) * static_cast<double>(medium.albedo[i])),
                  kSignificance)
            << c << " " << end;
      }
    }
  }
}

/// A world with a box whose inside scatters.
class Slab {
 public:
  Slab(float extinction, float albedo, float g, const Vec3& size)
      : medium_{Color::Constant(extinction), Color::Constant(albedo), g} {
    scene::Material glass = SceneBuilder::clear_glass();
    glass.thickness = 1.0f;
    SceneBuilder builder;
    builder.box(builder.material(glass), Vec3(-size.x(), -size.y(), -size.z()), Vec3(size.x(), size.y(), 0));
    scene_ = builder.scene();
    world_.emplace(scene_);
    context_.emplace(*world_, MisRule{}, 1 << 20);
  }

  /// A walk of a path that has entered at the top's middle in this direction.
  MediumWalk walk(const Vec3& direction, std::uint32_t number, Hit& hit, Ray& ray, int max_events = 1 << 20) {
    PathState path;
    path.inside = &medium_;
    path.sampler = Sampler(SamplerKind::independent, 1, 0, 0, number);
    path.seed = hash(number);
    ray = {.origin = Vec3(0, 0, -1e-4f), .direction = direction, .seed = path.seed};
    hit = {};
    world_->accel.intersect(std::span<const Ray>(&ray, 1), std::span<Hit>(&hit, 1), false);
    RayCounts counts;
    path.depth = max_events > 0 ? 0 : 1;
    return walk_medium(*context_, path, ray, hit, 1, counts, [](const auto&...) {});
  }

 private:
  scene::Scene scene_;
  std::optional<World> world_;
  std::optional<PathContext> context_;
  ScatteringMedium medium_;
};

TEST(MediumWalk, UnscatteredLightFollowsBeersLaw) {
  Slab slab(0.8f, 0.7f, 0.5f, Vec3(50, 50, 2));
  Moments unscattered;
  for (std::uint32_t i = 0; i < 40000; ++i) {
    Hit hit;
    Ray ray;
    const MediumWalk walk = slab.walk(Vec3(0, 0, -1), i, hit, ray);
    unscattered.add(walk.alive && walk.events == 0 ? static_cast<double>(walk.factor[0]) : 0.0);
  }
  EXPECT_GT(mean_p_value(unscattered, std::exp(-1.6), 1e-3), kSignificance);
}

TEST(MediumWalk, NothingIsLostWhereNothingIsAbsorbed) {
  for (const float g : {-0.9f, 0.0f, 0.9f}) {
    Slab slab(4.0f, 1.0f, g, Vec3(1, 1, 2));
    for (std::uint32_t i = 0; i < 2000; ++i) {
      Hit hit;
      Ray ray;
      const MediumWalk walk = slab.walk(Vec3(0, 0, -1), i, hit, ray);
      ASSERT_TRUE(walk.alive);
      ASSERT_TRUE(hit);
      ASSERT_NEAR(walk.factor[0], 1.0f, 2e-4f);
    }
  }
}

/// Chandrasekhar's H function for isotropic scattering: H(m) = 1 / (sqrt(1 - a) + a/2 int x H(x) / (m + x)
/// dx).
double diffuse_reflectance(double albedo) {
  constexpr int kNodes = 400;
  std::vector<double> h(kNodes, 1.0), next(kNodes);
  const auto at = [&](int i) { return (i + 0.5) / kNodes; };
  for (int step = 0; step < 2000; ++step) {
    double change = 0.0;
    for (int i = 0; i < kNodes; ++i) {
      double sum = 0.0;
      for (int j = 0; j < kNodes; ++j)
        sum += at(j) * h[static_cast<std::size_t>(j)] / (at(i) + at(j)) / kNodes;
      const auto k = static_cast<std::size_t>(i);
      next[k] = 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
      change = std::max(change, std::abs(next[k] - h[k]));
    }
    h = next;
    if (change < 1e-10) break;
  }
  double moment = 0.0;
  for (int i = 0; i < kNodes; ++i) moment += at(i) * h[static_cast<std::size_t>(i)] / kNodes;
  return 1.0 - 2.0 * std::sqrt(1.0 - albedo) * moment;
}

TEST(MediumWalk, AHalfSpaceReflectsAsChandrasekharComputed) {
  Random random;
  for (const double albedo : {0.1, 0.5, 0.8, 0.95, 0.999}) {
    Slab slab(1.0f, static_cast<float>(albedo), 0.0f, Vec3(4e3f, 4e3f, 4e3f));
    Moments reflected;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      const Vec2 u = random.pair();
      const float r = std::sqrt(u.x()), angle = 2.0f * kPi * u.y();
      const Vec3 direction(r * std::cos(angle), r * std::sin(angle), -std::sqrt(1.0f - u.x()));
      Hit hit;
      Ray ray;
      const MediumWalk walk = slab.walk(direction.normalized(), i, hit, ray);
      reflected.add(walk.alive ? static_cast<double>(walk.factor[0]) : 0.0);
    }
    EXPECT_GT(mean_p_value(reflected, diffuse_reflectance(albedo), 2e-3), kSignificance) << albedo;
  }
}

/// The colour that a file gives is the reflectance of a half space.
TEST(Albedo, IsTheInverseOfAHalfSpacesReflectance) {
  for (const float color : {0.02f, 0.1f, 0.3f, 0.5f, 0.7f, 0.9f, 0.98f}) {
    const auto albedo = static_cast<double>(single_scattering_albedo(Color::Constant(color), 0.0f)[0]);
    EXPECT_NEAR(diffuse_reflectance(albedo), static_cast<double>(color), 0.004) << color;
  }
  EXPECT_LT(single_scattering_albedo(Color::Zero(), 0.0f).maxCoeff(), 1e-4f);
  EXPECT_GT(single_scattering_albedo(Color::Ones(), 0.8f).minCoeff(), 1.0f - 1e-5f);
}

/// Means of pictures of a ball that scatters, with a lamp above it, for seeds of their own.
Moments means_of_ball(bool diffuse_door, bool absorbs_only, DirectLight direct, GlassShadows glass) {
  SceneBuilder builder;
  scene::Material body = SceneBuilder::clear_glass();
  body.thickness = 1.0f;
  body.attenuation_distance = 0.2f;
  body.attenuation_color = Color(0.5f, 0.3f, 0.1f);
  if (!absorbs_only) body.multiscatter_color = Color(0.9f, 0.7f, 0.5f);
  body.roughness = 0.6f;
  if (diffuse_door) {
    body.transmission = 0.0f;
    body.diffuse_transmission = 1.0f;
  }
  builder.sphere(builder.material(body), Vec3::Zero(), 0.5f, 24, true);
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(8.0f))),
               Vec3(-0.7f, 1.5f, -0.7f), Vec3(1.4f, 0, 0), Vec3(0, 0, 1.4f));
  RenderOptions options;
  options.width = options.height = 12;
  options.spp = 64;
  options.direct = direct;
  options.glass_shadows = glass;
  options.camera.look_at = LookAt{Vec3(0, 0.4f, 3), Vec3::Zero(), Vec3(0, 1, 0)};
  options.camera.fov_degrees = 18.0f;
  return testing::means_of_seeds(builder.scene(), options);
}

TEST(MediumWalk, LightSamplesAndBouncesAgreeOutsideOfABody) {
  for (const bool diffuse_door : {false, true}) {
    for (const bool absorbs_only : {false, true}) {
      for (const GlassShadows glass : {GlassShadows::refract, GlassShadows::straight}) {
        const Moments both = means_of_ball(diffuse_door, absorbs_only, DirectLight::mis, glass);
        const Moments bounces = means_of_ball(diffuse_door, absorbs_only, DirectLight::bsdf, glass);
        SCOPED_TRACE(::testing::Message()
                     << (diffuse_door ? "diffuse" : "rough") << (absorbs_only ? ", absorbs " : ", scatters ")
                     << static_cast<int>(glass));
        testing::expect_equal_means(both, bounces, 0.04);
      }
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
