#pragma once
// Pictures of each kind, small enough to be made a dozen times, and their comparison.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <ostream>
#include <utility>

#include "renderer/render.h"
#include "tests/support/denoiser.h"
#include "tests/support/room.h"

namespace gatelight::renderer::kinds {

inline RenderOptions picture_of(Integrator integrator) {
  RenderOptions options = testing::small_picture();
  options.integrator = integrator;
  options.width = 33;
  options.height = 20;
  options.spp = 5;
  options.nan_policy = NanPolicy::drop;
  options.clamp = 2.0f;
  options.cache.train_steps = 8;  // groups of 1, 1, 2, 4
  options.cache.batch = 600;
  options.cache.candidates = 4;
  options.cache.self_training.start_step = 4;
  options.cache.mlp.width = 16;
  if (uses_cache(integrator)) {
    options.aovs.push_back(Aov::cache_answer);
    options.aovs.push_back(Aov::training_count);
  }
  return options;
}

struct Result {
  Picture picture;
  RenderStatistics statistics;
};

/// Stops at the n-th call of the stop callback, once, like a caller that presses a key; 0: never.
inline Result result_of(const scene::Scene& scene, const RenderOptions& options, int stop_at = 0) {
  Renderer renderer(scene, options);
  std::atomic<int> calls{0};
  Callbacks callbacks;
  callbacks.stop = [&] { return ++calls == stop_at; };
  Picture picture = renderer.render(callbacks);
  return {std::move(picture), renderer.statistics()};
}

inline void expect_same(const Result& a, const Result& b) {
  ASSERT_EQ(a.picture.layers.size(), b.picture.layers.size());
  for (std::size_t i = 0; i < a.picture.layers.size(); ++i)
    EXPECT_TRUE(a.picture.layers[i].values == b.picture.layers[i].values) << a.picture.layers[i].name;
  EXPECT_EQ(a.picture.full_width, b.picture.full_width);
  EXPECT_EQ(a.picture.full_height, b.picture.full_height);
  const RenderStatistics& x = a.statistics;
  const RenderStatistics& y = b.statistics;
  EXPECT_EQ(x.spp, y.spp);
  EXPECT_EQ(x.samples, y.samples);
  EXPECT_EQ(x.rays.camera, y.rays.camera);
  EXPECT_EQ(x.rays.bounce, y.rays.bounce);
  EXPECT_EQ(x.rays.shadow, y.rays.shadow);
  EXPECT_EQ(x.clamped, y.clamped);
  EXPECT_EQ(x.cache.steps, y.cache.steps);
  EXPECT_EQ(x.cache.steps_wanted, y.cache.steps_wanted);
  EXPECT_EQ(x.cache.records, y.cache.records);
  EXPECT_EQ(x.cache.touched_nodes, y.cache.touched_nodes);
  EXPECT_EQ(x.cache.training_paths, y.cache.training_paths);
  EXPECT_EQ(x.cache.queries, y.cache.queries);
  EXPECT_EQ(x.cache.negative_answers, y.cache.negative_answers);
  EXPECT_EQ(x.cache.unstored_hits, y.cache.unstored_hits);
}

struct Kind {
  const char* name;
  Integrator integrator;
  std::function<void(RenderOptions&)> change;
};

inline void PrintTo(const Kind& kind, std::ostream* stream) {
  *stream << kind.name;
}

class Kinds : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    RenderOptions options;
    GetParam().change(options);
    if (options.denoise.denoiser == DenoiserKind::oidn) GATELIGHT_NEEDS_DENOISER();
  }
};

inline const Kind kKinds[] = {
    {"path", Integrator::path, [](RenderOptions&) {}},
    {"path_independent_region", Integrator::path,
     [](RenderOptions& o) {
       o.sampler = SamplerKind::independent;
       o.region = {{3, 2, 30, 19}};
       o.aovs.clear();
     }},
    {"path_denoised", Integrator::path,
     [](RenderOptions& o) {
       testing::denoise(o);
       o.aovs = {Aov::normal, Aov::raw, Aov::error, Aov::denoising};
     }},
    {"path_light_groups_denoised", Integrator::path,
     [](RenderOptions& o) {
       o.light_groups = {{"lamp", {"*"}}, {"sky", {"environment"}}};
       testing::denoise(o);
       o.aovs = {Aov::raw, Aov::diffuse_direct, Aov::glossy_indirect};
     }},
    {"ao", Integrator::ao, [](RenderOptions&) {}},
    {"nao", Integrator::nao, [](RenderOptions&) {}},
    {"nao_hashgrid", Integrator::nao,
     [](RenderOptions& o) {
       o.cache.encoding = neural::FeatureEncoding::hash_grid;
       o.cache.hash_grid.log2_table_size = 12;
       o.cache.candidates = 1;
     }},
    {"nrc", Integrator::nrc, [](RenderOptions&) {}},
    {"nrc_spread_uncounted", Integrator::nrc,
     [](RenderOptions& o) {
       o.cache.candidates = 1;
       o.cache.query_at = QueryAt::spread;
       o.cache.source = TrainingSource::surface;
       o.aovs.clear();
     }},
    {"nrc_learns_from_samples_denoised", Integrator::nrc,
     [](RenderOptions& o) {
       o.cache.candidates = 1;
       o.cache.source = TrainingSource::picture;
       o.cache.samples_from_step = 2;
       o.aovs = all_passes();
       testing::denoise(o);
     }},
    {"nrc_hashgrid", Integrator::nrc,
     [](RenderOptions& o) {
       o.cache.encoding = neural::FeatureEncoding::hash_grid;
       o.cache.candidates = 1;
       o.cache.hash_grid.log2_table_size = 10;
       o.cache.training.precision = neural::FeaturePrecision::fp16;
       o.cache.query_at = QueryAt::primary;
     }},
};

}  // namespace gatelight::renderer::kinds
