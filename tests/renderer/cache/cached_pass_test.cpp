// Pictures with a cache: the right light, the same bits, and a defined picture where nothing was or could be
// learned.

#include "renderer/cache/cached_pass.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/render.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

RenderOptions small(Integrator integrator) {
  RenderOptions options;
  options.integrator = integrator;
  options.width = 64;
  options.height = 48;
  options.spp = 4;
  options.max_depth = 32;
  options.cache.train_steps = 60;
  options.cache.batch = 2048;
  options.cache.node_spacing = 0.7f;
  options.cache.self_training.start_step = 20;
  return options;
}

const std::vector<float>& pixels(const Picture& picture) {
  return picture.layers[0].values;
}

Moments moments_of(const Picture& picture) {
  Moments moments;
  for (const float v : pixels(picture)) moments.add(static_cast<double>(v));
  return moments;
}

void expect_sound(const Picture& picture) {
  for (const Layer& layer : picture.layers) {
    for (const float v : layer.values) ASSERT_TRUE(std::isfinite(v)) << layer.name;
  }
  for (const float v : pixels(picture)) ASSERT_GE(v, 0.0f);
}

void expect_same_picture(const Picture& a, const Picture& b, const std::string& what) {
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); ++i)
    EXPECT_EQ(a.layers[i].values, b.layers[i].values) << what << ", layer " << a.layers[i].name;
}

struct Setting {
  CacheHolds holds;
  QueryAt query_at;
};

std::string name_of(const Setting& s) {
  const char* const holds[] = {"All", "NoDelta", "Indirect"};
  const char* const at[] = {"Primary", "Gather", "Spread", "None"};
  return std::string(holds[static_cast<std::size_t>(s.holds)]) + at[static_cast<std::size_t>(s.query_at)];
}

class CachedFurnace : public ::testing::TestWithParam<Setting> {};

TEST_P(CachedFurnace, ShowsEmissionOverOneMinusAlbedo) {
  const SceneBuilder builder = testing::closed_furnace(0.6f, 2.0f);
  RenderOptions options = small(Integrator::nrc);
  options.cache.holds = GetParam().holds;
  options.cache.query_at = GetParam().query_at;
  SceneBuilder made = builder;
  Renderer renderer(made.scene(), options);
  const Picture picture = renderer.render();
  expect_sound(picture);
  EXPECT_NEAR(moments_of(picture).mean() / (2.0 / (1.0 - 0.6)), 1.0, 0.03);
  const CacheStatistics& s = renderer.statistics().cache;
  const double paths = GetParam().query_at == QueryAt::none ? 0.0 : 64.0 * 48.0 * 4.0;
  // One query a path, except for paths that roulette ends before they have spread.
  EXPECT_NEAR(static_cast<double>(s.queries), paths, GetParam().query_at == QueryAt::spread ? 100.0 : 0.0);
  EXPECT_EQ(s.unstored_hits, 0u);
  EXPECT_EQ(s.steps, 60);
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const CacheHolds holds : {CacheHolds::all, CacheHolds::no_delta, CacheHolds::indirect}) {
    for (const QueryAt at : {QueryAt::primary, QueryAt::gather, QueryAt::spread, QueryAt::none}) {
      if (at != QueryAt::none || holds == CacheHolds::all) all.push_back({holds, at});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Settings, CachedFurnace, ::testing::ValuesIn(settings()),
                         [](const auto& setting) { return name_of(setting.param); });

/// A room with a lamp, a sun through its open front, a mirror, glass, gloss, and a veil.
SceneBuilder room() {
  SceneBuilder builder;
  const int wall = builder.material(SceneBuilder::lambert(Color(0.7f, 0.6f, 0.5f)));
  builder.quad(wall, Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  builder.quad(wall, Vec3(-2, 0, -2), Vec3(4, 0, 0), Vec3(0, 3, 0));
  builder.quad(wall, Vec3(-2, 0, 2), Vec3(0, 0, -4), Vec3(0, 3, 0));
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color(9.0f, 8.0f, 7.0f))),
               Vec3(-0.5f, 2.9f, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1));
  scene::Material mirror;
  mirror.base_color = Color::Constant(0.9f);
  mirror.roughness = 0.0f;
  builder.quad(builder.material(mirror), Vec3(0.2f, 0.2f, -1.9f), Vec3(1.5f, 0, 0), Vec3(0, 2, 0));
  scene::Material glass = SceneBuilder::clear_glass();
  glass.thickness = 1.0f;
  builder.sphere(builder.material(glass), Vec3(0.9f, 0.5f, 0.2f), 0.5f, 16, true);
  scene::Material gloss;
  gloss.base_color = Color(0.2f, 0.4f, 0.8f);
  gloss.metallic = 0.0f;
  gloss.roughness = 0.2f;
  builder.sphere(builder.material(gloss), Vec3(-0.7f, 0.5f, 0), 0.5f, 16, true);
  scene::Material veil = SceneBuilder::lambert(Color(0.2f, 0.3f, 0.9f));
  veil.alpha_mode = scene::AlphaMode::blend;
  veil.base_alpha = 0.4f;
  veil.double_sided = true;
  builder.quad(builder.material(veil), Vec3(-1, 0.2f, 0.9f), Vec3(1, 0, 0), Vec3(0, 1, 0));
  scene::PunctualLight sun;
  sun.type = scene::LightType::directional;
  sun.direction = Vec3(-0.3f, -0.6f, -0.5f).normalized();
  sun.intensity = Color(1.0f, 0.9f, 0.7f);
  builder.scene().lights = {sun};
  builder.scene().cameras.push_back(view_from(Vec3(0.4f, 1.3f, 4), Vec3(0, 1, 0)));
  return builder;
}

const std::vector<Aov> kAllOfTheCache = {Aov::albedo,         Aov::cache_answer, Aov::cache_error,
                                         Aov::training_count, Aov::resolution,   Aov::nearest_node};

TEST(CachedPass, AnyNumberOfThreadsGivesTheSameBits) {
  SceneBuilder builder = room();
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
    RenderOptions options = small(integrator);
    options.environment.constant = Color(0.2f, 0.3f, 0.5f);
    options.aovs = kAllOfTheCache;
    options.max_depth = 5;
    options.spp = 2;
    options.cache.train_steps = 6;
    options.cache.self_training.start_step = 2;
    Picture one;
    CacheStatistics expected;
    for (const int threads : {1, 2, 7}) {
      options.threads = threads;
      Renderer renderer(builder.scene(), options);
      const Picture picture = renderer.render();
      const CacheStatistics& s = renderer.statistics().cache;
      if (threads == 1) {
        one = picture;
        expected = s;
        expect_sound(one);
        continue;
      }
      expect_same_picture(one, picture, std::to_string(threads) + " threads");
      EXPECT_EQ(s.negative_answers, expected.negative_answers);
      EXPECT_EQ(s.queries, expected.queries);
      EXPECT_EQ(s.unstored_hits, expected.unstored_hits);
      EXPECT_EQ(s.records, expected.records);
      EXPECT_EQ(s.loss, expected.loss);
    }
  }
}

/// One pass over a region with a trained session.
Picture pass_over(const ViewedWorld& viewed, const RenderOptions& options, CacheSession& session,
                  const PixelRect& region, CacheStatistics* statistics = nullptr) {
  const TileGrid tiles(region);
  const FilterSampler filter(options.filter, options.filter_width);
  const PassContext context{tiles, options, viewed.camera, filter};
  Film film(region, viewed.region.width(), viewed.region.height(), film_contents(options));
  CachedPass pass(viewed.world, context, session);
  pass.run(options.spp, film, [](double) {});
  if (statistics) pass.add_to(*statistics);
  return film.resolve();
}

TEST(CachedPass, ARegionOfATrainedCacheIsThatPartOfTheWhole) {
  const ViewedWorld viewed(room(), {.constant = Color(0.2f, 0.3f, 0.5f)});
  for (const QueryAt at : {QueryAt::primary, QueryAt::gather}) {
    RenderOptions options = small(Integrator::nrc);
    options.max_depth = 5;
    options.spp = 2;
    options.cache.query_at = at;
    CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    session.train(5, {});
    const Picture whole = pass_over(viewed, options, session, viewed.region);
    const Picture part = pass_over(viewed, options, session, {16, 16, 64, 32});
    ASSERT_EQ(part.width, 48);
    ASSERT_EQ(part.height, 16);
    for (int y = 0; y < part.height; ++y) {
      for (int i = 0; i < part.width * 3; ++i) {
        ASSERT_EQ(pixels(part)[static_cast<std::size_t>(y * part.width * 3 + i)],
                  pixels(whole)[static_cast<std::size_t>(((y + 16) * whole.width + 16) * 3 + i)]);
      }
    }
  }
}

TEST(CachedPass, CacheRadianceIsThePictureOfPathsThatEndAtTheFirstHit) {
  // A mirror and matte walls: the part of a path before the query has no noise.
  SceneBuilder builder;
  const int wall = builder.material(SceneBuilder::lambert(Color(0.7f, 0.6f, 0.5f)));
  builder.quad(wall, Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  builder.quad(wall, Vec3(-2, 0, -2), Vec3(4, 0, 0), Vec3(0, 3, 0));
  scene::Material mirror;
  mirror.base_color = Color::Constant(0.9f);
  mirror.roughness = 0.0f;
  builder.quad(builder.material(mirror), Vec3(0.2f, 0.2f, -1.9f), Vec3(1.5f, 0, 0), Vec3(0, 2, 0));
  scene::PunctualLight sun;
  sun.type = scene::LightType::directional;
  sun.direction = Vec3(-0.3f, -0.6f, -0.5f).normalized();
  sun.intensity = Color(1.0f, 0.9f, 0.7f);
  builder.scene().lights = {sun};
  builder.scene().cameras.push_back(view_from(Vec3(0.4f, 1.3f, 4), Vec3(0, 1, 0)));
  for (const CacheHolds holds : {CacheHolds::all, CacheHolds::no_delta}) {
    // Where the cache does not store the sun, other lights would take samples from it.
    const bool sky = holds == CacheHolds::all;
    const ViewedWorld viewed(builder, {.constant = sky ? Color(0.2f, 0.3f, 0.5f) : Color(Color::Zero())});
    RenderOptions options = small(Integrator::nrc);
    options.aovs = {Aov::cache_radiance};
    options.cache.holds = holds;
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

TEST(CachedPass, SurfacesWithoutStorageAreTraced) {
  SceneBuilder builder = room();
  const EnvironmentOptions sky{.constant = Color(0.2f, 0.3f, 0.5f)};
  const ViewedWorld viewed(builder, sky);
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
    RenderOptions options = small(integrator);
    options.environment = sky;
    options.max_depth = 5;
    options.cache.query_at = QueryAt::primary;
    CacheSetup setup;
    setup.sides.assign(viewed.world.scene.instances.size(), neural::Sides::none);
    CacheSession session(viewed.world, viewed.camera, viewed.region, options, &setup);
    session.train(2, {});
    EXPECT_EQ(session.statistics().records, 0u);
    CacheStatistics statistics;
    const Picture cached = pass_over(viewed, options, session, viewed.region, &statistics);
    EXPECT_EQ(statistics.queries, 0u);
    EXPECT_GT(statistics.unstored_hits, 1000u);

    RenderOptions traced = options;
    traced.integrator = integrator == Integrator::nrc ? Integrator::path : Integrator::ao;
    const Picture reference = Renderer(builder.scene(), traced).render();
    for (std::size_t i = 0; i < pixels(reference).size(); ++i)
      ASSERT_NEAR(pixels(cached)[i], pixels(reference)[i], 1e-4f * (1.0f + pixels(reference)[i])) << i;
  }
}

TEST(CachedPass, ASceneMayMixInstancesWithAndWithoutStorage) {
  SceneBuilder builder = testing::closed_furnace(0.6f, 2.0f);
  builder.box(0, Vec3(-0.8f, -0.9f, -1.0f), Vec3(0.6f, 0.4f, 0.2f));
  const ViewedWorld viewed(builder);
  RenderOptions options = small(Integrator::nrc);
  options.cache.query_at = QueryAt::primary;
  CacheSetup setup;
  setup.sides = {neural::Sides::front, neural::Sides::none};
  setup.node_spacing = 0.7f;
  setup.target_scale = 0.2f;
  setup.records_per_path = 2.0f;
  setup.records_per_short_path = 2.0f;
  CacheSession session(viewed.world, viewed.camera, viewed.region, options, &setup);
  session.train(60, {});
  CacheStatistics statistics;
  const Picture picture = pass_over(viewed, options, session, viewed.region, &statistics);
  EXPECT_GT(statistics.queries, 3000u);
  EXPECT_GT(statistics.unstored_hits, 1000u);
  EXPECT_NEAR(moments_of(picture).mean(), 5.0, 0.15);
}

TEST(CachedPass, ASideWithoutStorageDoesNotReadTheOther) {
  // A single-sided material does not distinguish its sides.
  scene::Material card = SceneBuilder::lambert(Color::Constant(0.5f));
  for (const bool double_sided : {true, false}) {
    card.double_sided = double_sided;
    SceneBuilder made;
    made.quad(made.material(card), Vec3(-5, -5, 0), Vec3(0, 10, 0), Vec3(10, 0, 0));
    made.scene().cameras.push_back(view_from(Vec3(0, 0, 2), Vec3::Zero()));  // sees its back
    const ViewedWorld viewed(made, {.constant = Color::Ones()});
    RenderOptions options = small(Integrator::nrc);
    options.cache.query_at = QueryAt::primary;
    options.spp = 1;
    CacheSetup setup;
    setup.sides = {neural::Sides::front};
    CacheSession session(viewed.world, viewed.camera, viewed.region, options, &setup);
    session.train(2, {});
    EXPECT_EQ(session.statistics().records > 0, !double_sided);
    CacheStatistics statistics;
    pass_over(viewed, options, session, viewed.region, &statistics);
    EXPECT_EQ(statistics.queries, double_sided ? 0u : 64u * 48u);
    EXPECT_EQ(statistics.unstored_hits, double_sided ? 64u * 48u : 0u);
  }
}

TEST(CachedPass, NegativeAnswersAreCountedAndBlack) {
  const ViewedWorld viewed(room(), {.constant = Color(0.2f, 0.3f, 0.5f)});
  RenderOptions options = small(Integrator::nrc);
  options.max_depth = 5;
  options.aovs = {Aov::cache_answer};
  for (const QueryAt at : {QueryAt::primary, QueryAt::gather}) {
    options.cache.query_at = at;
    CacheSession session(viewed.world, viewed.camera, viewed.region, options);
    CacheState state = session.export_state();
    const neural::LayerLayout& last = session.model().parameters.layers.back();
    for (std::uint64_t i = 0; i < last.outputs; ++i) state.model.averages[last.biases + i] = -100.0f;
    session.import_state(state);
    CacheStatistics statistics;
    const Picture picture = pass_over(viewed, options, session, viewed.region, &statistics);
    expect_sound(picture);
    EXPECT_GT(statistics.queries, 1000u);
    EXPECT_EQ(statistics.negative_answers, statistics.queries);
    for (const float v : picture.find("cache-answer")->values) ASSERT_EQ(v, 0.0f);
  }
}

TEST(CachedPass, WithoutQueriesTheCachesViewIsTheMeanOfRecords) {
  // Sun and sky over a plane that emits light: closed forms of the light that the cache stores.
  SceneBuilder builder;
  builder.quad(builder.material(SceneBuilder::lambert(Color(0.2f, 0.7f, 0.4f), Color::Constant(5.0f))),
               Vec3(-500, 0, 500), Vec3(1000, 0, 0), Vec3(0, 0, -1000));
  builder.scene().cameras.push_back(view_from(Vec3(0, 2, 0), Vec3(0, 0, 0)));
  scene::PunctualLight sun;
  sun.type = scene::LightType::directional;
  sun.direction = Vec3(0.6f, -0.8f, 0.0f);
  sun.intensity = Color(1.0f, 2.0f, 3.0f);
  builder.scene().lights = {sun};
  for (const CacheHolds holds : {CacheHolds::all, CacheHolds::no_delta, CacheHolds::indirect}) {
    RenderOptions options = small(Integrator::nrc);
    options.environment.constant = Color(0.1f, 0.3f, 0.9f);
    options.sampler = SamplerKind::independent;
    options.filter = PixelFilter::box;
    options.cache.train_steps = 0;
    options.cache.view = CacheView::cache;
    options.cache.query_at = QueryAt::none;
    options.cache.holds = holds;
    const Picture picture = Renderer(builder.scene(), options).render();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto sky = static_cast<double>(options.environment.constant[static_cast<Eigen::Index>(c)]);
      const double sunlight = static_cast<double>(c + 1) * 0.8 / M_PI;
      const double expected = holds == CacheHolds::all        ? sky + sunlight
                              : holds == CacheHolds::no_delta ? sky
                                                              : 0.0;
      Moments moments;
      for (std::size_t i = c; i < pixels(picture).size(); i += 3)
        moments.add(static_cast<double>(pixels(picture)[i]));
      EXPECT_GT(testing::mean_p_value(moments, expected, 1e-4), testing::sidak(1e-4, 9))
          << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
    }
  }
}

TEST(CachedPass, TheCachesViewIsTheLearnedLight) {
  SceneBuilder builder = testing::closed_furnace(0.6f, 2.0f);
  RenderOptions options = small(Integrator::nrc);
  options.cache.view = CacheView::cache;
  for (const QueryAt at : {QueryAt::primary, QueryAt::gather}) {
    options.cache.query_at = at;
    Renderer renderer(builder.scene(), options);
    // The view has neither the emission nor the reflectance of the visible surface.
    EXPECT_NEAR(moments_of(renderer.render()).mean(), 5.0, 0.15);
  }
}

TEST(CachedPass, OcclusionIsNearTheReference) {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  builder.box(matte, Vec3(-2, 0, -2), Vec3(2, 2, 2), true);
  builder.box(matte, Vec3(-0.6f, 0.001f, -1), Vec3(0.4f, 0.8f, -0.2f));
  builder.scene().cameras.push_back(view_from(Vec3(0.4f, 1.3f, 1.9f), Vec3(0, 0.5f, 0)));
  RenderOptions options = small(Integrator::nao);
  options.ao_distance = 1.0f;
  options.spp = 8;
  options.cache.train_steps = 100;
  options.cache.node_spacing = 0.15f;
  const Picture cached = Renderer(builder.scene(), options).render();
  expect_sound(cached);
  options.integrator = Integrator::ao;
  options.spp = 256;
  const Picture reference = Renderer(builder.scene(), options).render();
  EXPECT_NEAR(moments_of(cached).mean(), moments_of(reference).mean(), 0.01);
  double squared = 0.0;
  for (std::size_t i = 0; i < pixels(cached).size(); ++i)
    squared += std::pow(static_cast<double>(pixels(cached)[i] - pixels(reference)[i]), 2.0);
  // The picture's own contrast is 0.2; one sample a pixel has an error of 0.4.
  EXPECT_LT(std::sqrt(squared / static_cast<double>(pixels(cached).size())), 0.05);
  EXPECT_GT(moments_of(reference).variance(), 0.02);
}

TEST(CachedPass, ErrorsAreThoseOfTheVertexOfTheQuery) {
  // A visible floor and an emitting ceiling, endless, at a distance of one metre. By directions of the BSDF
  // without MIS every target is exact: 40/3 on the floor, 20/3 on the ceiling.
  SceneBuilder builder;
  const Color half = Color::Constant(0.5f);
  builder.quad(builder.material(SceneBuilder::lambert(half)), Vec3(-5e3f, 0, 5e3f), Vec3(1e4f, 0, 0),
               Vec3(0, 0, -1e4f));
  builder.quad(builder.material(SceneBuilder::lambert(half, Color::Constant(10.0f))), Vec3(-5e3f, 1, -5e3f),
               Vec3(1e4f, 0, 0), Vec3(0, 0, 1e4f));
  builder.scene().cameras.push_back(view_from(Vec3(0, 0.9f, 0), Vec3::Zero()));
  RenderOptions options = small(Integrator::nrc);
  options.direct = DirectLight::bsdf;
  options.min_depth = 64;
  options.cache.node_spacing = 1e4f;
  options.cache.self_training.start_step = -1;
  options.aovs = {Aov::cache_answer, Aov::cache_error};
  for (const QueryAt at : {QueryAt::primary, QueryAt::gather}) {
    options.cache.query_at = at;
    const Picture picture = Renderer(builder.scene(), options).render();
    Moments answers;
    for (const float a : picture.find("cache-answer")->values) answers.add(static_cast<double>(a));
    EXPECT_NEAR(answers.mean(), (at == QueryAt::primary ? 40.0 : 20.0) / 3.0, 1.0)
        << "except for the light that paths of the greatest depth miss";
    Moments errors;
    for (const float e : picture.find("cache-error")->values) errors.add(static_cast<double>(e));
    EXPECT_GT(errors.mean(), 0.0);
    EXPECT_LT(errors.mean(), 0.02) << "against the other plane's records it would be 1 or 1/4";
  }
}

}  // namespace
}  // namespace gatelight::renderer
