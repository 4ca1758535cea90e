// Pictures with a cache: parts of them, and a defined picture where nothing was or could be learned.

#include "renderer/cache/cached_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "renderer/render.h"
#include "tests/renderer/cache/cached_pictures.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::moments_of;
using testing::SceneBuilder;
using testing::view_from;
using testing::ViewedWorld;

/// Walls and a mirror with a side wall, a lamp, glass, gloss, and a veil.
SceneBuilder room_with_glass() {
  SceneBuilder builder = walls_and_mirror();
  builder.quad(0, Vec3(-2, 0, 2), Vec3(0, 0, -4), Vec3(0, 3, 0));
  builder.quad(builder.material(SceneBuilder::lambert(Color::Zero(), Color(9.0f, 8.0f, 7.0f))),
               Vec3(-0.5f, 2.9f, -0.5f), Vec3(1, 0, 0), Vec3(0, 0, 1));
  builder.sphere(builder.material(testing::solid_glass()), Vec3(0.9f, 0.5f, 0.2f), 0.5f, 16, true);
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
  return builder;
}

TEST(CachedPass, ARegionOfATrainedCacheIsThatPartOfTheWhole) {
  const ViewedWorld viewed(room_with_glass(), {.constant = Color(0.2f, 0.3f, 0.5f)});
  for (const QueryAt at : {QueryAt::primary, QueryAt::gather}) {
    RenderOptions options = cached_picture(Integrator::nrc);
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

TEST(CachedPass, SurfacesWithoutStorageAreTraced) {
  SceneBuilder builder = room_with_glass();
  const EnvironmentOptions sky{.constant = Color(0.2f, 0.3f, 0.5f)};
  const ViewedWorld viewed(builder, sky);
  for (const Integrator integrator : {Integrator::nrc, Integrator::nao}) {
    RenderOptions options = cached_picture(integrator);
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

TEST(CachedPass, ASideWithoutStorageDoesNotReadTheOther) {
  // A single-sided material does not distinguish its sides.
  scene::Material card = SceneBuilder::lambert(Color::Constant(0.5f));
  for (const bool double_sided : {true, false}) {
    card.double_sided = double_sided;
    SceneBuilder made;
    made.quad(made.material(card), Vec3(-5, -5, 0), Vec3(0, 10, 0), Vec3(10, 0, 0));
    made.scene().cameras.push_back(view_from(Vec3(0, 0, 2), Vec3::Zero()));  // sees its back
    const ViewedWorld viewed(made, {.constant = Color::Ones()});
    RenderOptions options = cached_picture(Integrator::nrc);
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
  const ViewedWorld viewed(room_with_glass(), {.constant = Color(0.2f, 0.3f, 0.5f)});
  RenderOptions options = cached_picture(Integrator::nrc);
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

/// A box on the floor of a closed box, by a cache of occlusion.
struct OcclusionScene {
  OcclusionScene() {
    const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
    builder.box(matte, Vec3(-2, 0, -2), Vec3(2, 2, 2), true);
    builder.box(matte, Vec3(-0.6f, 0.001f, -1), Vec3(0.4f, 0.8f, -0.2f));
    builder.scene().cameras.push_back(view_from(Vec3(0.4f, 1.3f, 1.9f), Vec3(0, 0.5f, 0)));
  }
  Picture render(Integrator integrator, int spp, std::uint32_t seed) {
    RenderOptions options = cached_picture(integrator);
    options.ao_distance = 1.0f;
    options.spp = spp;
    options.seed = seed;
    options.cache.train_steps = 100;
    options.cache.node_spacing = 0.15f;
    return Renderer(builder.scene(), options).render();
  }
  SceneBuilder builder;
};

double rms_difference(const Picture& a, const Picture& b) {
  double squared = 0.0;
  for (std::size_t i = 0; i < pixels(a).size(); ++i)
    squared += std::pow(static_cast<double>(pixels(a)[i] - pixels(b)[i]), 2.0);
  return std::sqrt(squared / static_cast<double>(pixels(a).size()));
}

TEST(CachedPass, OcclusionIsNearTheReference) {
  // Measured with the seeds 1 to 32 against a reference of 256 samples, whose own error is 0.0002.
  constexpr testing::MeasuredError kError = {0.0007, 0.0023, 32};
  OcclusionScene scene;
  const Picture cached = scene.render(Integrator::nao, 8, 0);
  const Picture reference = scene.render(Integrator::ao, 256, 0);
  expect_sound(cached);
  const double mean = moments_of(cached).mean();
  EXPECT_GT(testing::MeasuredErrors().p_value(mean, moments_of(reference).mean(), kError), 1e-4) << mean;
  // The same seeds measured 0.0138 with a standard deviation of 0.0006; the bound is 1.5 times as much. The
  // picture's own contrast is 0.2; one sample a pixel has an error of 0.4.
  EXPECT_LT(rms_difference(cached, reference), 1.5 * 0.0138);
  EXPECT_GT(moments_of(reference).variance(), 0.02);
}

}  // namespace
}  // namespace gatelight::renderer
