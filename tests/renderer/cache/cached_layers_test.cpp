// Layers and views of the cache: its radiance, its records, its errors.

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "renderer/render.h"
#include "tests/renderer/cache/cached_pictures.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

TEST(CachedLayers, CacheRadianceIsThePictureOfPathsThatEndAtTheFirstHit) {
  // A mirror and matte walls: the part of a path before the query has no noise.
  const SceneBuilder builder = walls_and_mirror();
  for (const CachedComponent holds : {CachedComponent::all, CachedComponent::no_delta}) {
    // Where the cache does not store the sun, other lights would take samples from it.
    const bool sky = holds == CachedComponent::all;
    const ViewedWorld viewed(builder, {.constant = sky ? Color(0.2f, 0.3f, 0.5f) : Color(Color::Zero())});
    RenderOptions options = cached_picture(Integrator::nrc);
    options.aovs = {Aov::cache_radiance};
    options.cache.component = holds;
    CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    session.train(20, {});
    options.cache.query_at = QueryAt::primary;
    const Picture expected = pass_over(viewed, options, session, viewed.region);
    for (const QueryAt at : {QueryAt::primary, QueryAt::gather, QueryAt::none}) {
      options.cache.query_at = at;
      const Picture picture = pass_over(viewed, options, session, viewed.region);
      const std::vector<float>& values = picture.find("cache-radiance")->values;
      for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_NEAR(values[i], pixels(expected)[i], 1e-5f * (1.0f + pixels(expected)[i])) << i;
    }
  }
}

TEST(CachedLayers, WithoutQueriesTheCachesViewIsTheMeanOfRecords) {
  // Sun and sky over a plane that emits light: closed forms of the light that the cache stores.
  SceneBuilder builder;
  testing::add_floor(builder, SceneBuilder::lambert(Color(0.2f, 0.7f, 0.4f), Color::Constant(5.0f)), 500);
  builder.scene().cameras.push_back(view_from(Vec3(0, 2, 0), Vec3(0, 0, 0)));
  builder.scene().lights = {testing::sun(Vec3(0.6f, -0.8f, 0.0f), Color(1.0f, 2.0f, 3.0f))};
  for (const CachedComponent holds :
       {CachedComponent::all, CachedComponent::no_delta, CachedComponent::indirect}) {
    RenderOptions options = cached_picture(Integrator::nrc);
    options.environment.constant = Color(0.1f, 0.3f, 0.9f);
    options.sampler = SamplerKind::independent;
    options.filter = PixelFilter::box;
    options.cache.train_steps = 0;
    options.cache.view = CacheOutput::cache;
    options.cache.query_at = QueryAt::none;
    options.cache.component = holds;
    const Picture picture = Renderer(builder.scene(), options).render();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto sky = static_cast<double>(options.environment.constant[static_cast<Eigen::Index>(c)]);
      const double sunlight = static_cast<double>(c + 1) * 0.8 / M_PI;
      const double expected = holds == CachedComponent::all        ? sky + sunlight
                              : holds == CachedComponent::no_delta ? sky
                                                                   : 0.0;
      const Moments moments = testing::channel_moments(picture, c);
      EXPECT_GT(testing::mean_p_value(moments, expected, 1e-4), testing::sidak(1e-4, 11))
          << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
    }
  }
}

struct AnswersAndErrors {
  Moments answers, errors;
};

/// A visible floor and an emitting ceiling, endless, at a distance of one metre. By directions of the BSDF
/// without MIS every target is exact: 40/3 on the floor, 20/3 on the ceiling.
AnswersAndErrors between_endless_planes(QueryAt at, std::uint32_t seed) {
  SceneBuilder builder;
  const Color half = Color::Constant(0.5f);
  builder.quad(builder.material(SceneBuilder::lambert(half)), Vec3(-5e3f, 0, 5e3f), Vec3(1e4f, 0, 0),
               Vec3(0, 0, -1e4f));
  builder.quad(builder.material(SceneBuilder::lambert(half, Color::Constant(10.0f))), Vec3(-5e3f, 1, -5e3f),
               Vec3(1e4f, 0, 0), Vec3(0, 0, 1e4f));
  builder.scene().cameras.push_back(view_from(Vec3(0, 0.9f, 0), Vec3::Zero()));
  RenderOptions options = cached_picture(Integrator::nrc);
  options.seed = seed;
  options.direct = DirectLight::bsdf;
  options.min_depth = 64;
  options.cache.query_at = at;
  options.cache.node_spacing = 1e4f;
  options.cache.self_training.start_step = -1;
  options.aovs = {Aov::cache_answer, Aov::cache_error};
  const Picture picture = Renderer(builder.scene(), options).render();
  AnswersAndErrors result;
  for (const float a : picture.find("cache-answer")->values) result.answers.add(static_cast<double>(a));
  for (const float e : picture.find("cache-error")->values) result.errors.add(static_cast<double>(e));
  return result;
}

TEST(CachedLayers, ErrorsAreThoseOfTheVertexOfTheQuery) {
  // Measured with the seeds 1 to 16. The bias has the light that paths of the greatest depth miss.
  const std::pair<QueryAt, testing::MeasuredError> cases[] = {{QueryAt::primary, {-0.0112, 0.00095, 16}},
                                                              {QueryAt::gather, {-0.0412, 0.00079, 16}}};
  for (const auto& [at, error] : cases) {
    const AnswersAndErrors layers = between_endless_planes(at, 0);
    const double exact = (at == QueryAt::primary ? 40.0 : 20.0) / 3.0;
    EXPECT_GT(testing::MeasuredErrors().p_value(layers.answers.mean(), exact, error),
              testing::sidak(1e-4, 11))
        << layers.answers.mean();
    EXPECT_GT(layers.errors.mean(), 0.0);
    EXPECT_LT(layers.errors.mean(), 0.02) << "against the other plane's records it would be 1 or 1/4";
  }
}

}  // namespace
}  // namespace gatelight::renderer
