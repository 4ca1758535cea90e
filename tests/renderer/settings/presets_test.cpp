// Presets set the values that they promise, and no others.

#include "renderer/settings/presets.h"

#include <gtest/gtest.h>

namespace gatelight::renderer {

namespace {

/// Expects the settings of the paper's experiments, for both applications.
void expect_papers(const RenderOptions& options) {
  const CacheOptions& cache = options.cache;
  EXPECT_EQ(options.width, 1920);
  EXPECT_EQ(options.height, 1080);
  EXPECT_EQ(options.spp, 1);
  EXPECT_EQ(cache.batch, 49152u);
  EXPECT_EQ(cache.path_length, 4);
  EXPECT_EQ(cache.samples_per_point, 1);
  EXPECT_EQ(cache.candidates, 16);
  EXPECT_EQ(cache.source, TrainingSource::camera);
  EXPECT_LT(cache.self_training.start_step, 0);
  EXPECT_EQ(cache.encoding, neural::FeatureEncoding::gate);
  EXPECT_EQ(cache.gate.stack, (std::vector<std::uint32_t>{neural::kAdaptive, 1}));
  EXPECT_EQ(cache.gate.rule, neural::ResolutionRule::paper);
  EXPECT_FALSE(cache.gate.cluster);
  EXPECT_EQ(cache.gate.max_resolution, 32u);
  EXPECT_EQ(cache.mlp.width, 32u);
  EXPECT_EQ(cache.mlp.hidden_layers, 2u);
  EXPECT_FLOAT_EQ(cache.mlp.leaky_slope, 0.01f);
  EXPECT_FALSE(cache.mlp.biases);
  EXPECT_EQ(cache.training.loss, neural::Loss::l2);
  EXPECT_EQ(cache.training.update, neural::FeatureUpdate::sparse);
  EXPECT_EQ(cache.training.feature_step, neural::FeatureStep::per_triangle);
  EXPECT_EQ(cache.training.precision, neural::FeaturePrecision::fp32);
  EXPECT_FALSE(cache.training.average.network || cache.training.average.features);
  EXPECT_EQ(cache.training.adam.decay_steps, 0.0f);
  EXPECT_FALSE(cache.training.start_at_mean);
  EXPECT_EQ(cache.component, CachedComponent::all);
  EXPECT_EQ(cache.query_at, QueryAt::primary);
  EXPECT_EQ(cache.view, CacheOutput::cache);
  EXPECT_EQ(cache.hash_grid.levels, 8u);
  EXPECT_EQ(cache.hash_grid.features, 4u);
  EXPECT_EQ(cache.hash_grid.base_resolution, 2u);
}

TEST(Presets, ThePapersAreTheirExperiments) {
  struct Paper {
    CachePreset preset;
    Integrator integrator;
    std::uint32_t features;
    int train_steps;
  };
  for (const Paper& paper : {Paper{CachePreset::paper_nao, Integrator::nao, 2, 128},
                             Paper{CachePreset::paper_nrc, Integrator::nrc, 8, 1024}}) {
    RenderOptions options;
    options.cache.samples_per_point = 7;
    options.cache.cache_in = "learned by other rules";
    apply_preset(paper.preset, options);
    EXPECT_EQ(options.integrator, paper.integrator);
    expect_papers(options);
    EXPECT_EQ(options.cache.gate.features, paper.features);
    EXPECT_EQ(options.cache.train_steps, paper.train_steps);
    EXPECT_EQ(options.cache.cache_in, "") << "all options of the cache are replaced";
  }
}

TEST(Presets, BareQueriesAtTheFirstVertexAndShowsTheAnswers) {
  RenderOptions options;
  apply_preset(CachePreset::bare, options);
  EXPECT_EQ(options.integrator, Integrator::nrc);
  EXPECT_EQ(options.cache.query_at, QueryAt::primary);
  EXPECT_EQ(options.cache.source, TrainingSource::camera);
  EXPECT_EQ(options.denoise.denoiser, DenoiserKind::none);
}

TEST(Presets, FinishedPicturesAreDenoisedAndLearnFromTheirSamples) {
  int spp = 0;
  for (const CachePreset preset : {CachePreset::preview, CachePreset::standard, CachePreset::final}) {
    RenderOptions options;
    apply_preset(preset, options);
    EXPECT_EQ(options.integrator, Integrator::nrc);
    EXPECT_EQ(options.denoise.denoiser, DenoiserKind::automatic);
    EXPECT_EQ(options.cache.source, TrainingSource::picture);
    EXPECT_EQ(options.cache.query_at, QueryAt::spread);
    EXPECT_EQ(options.cache.component, CachedComponent::no_delta);
    EXPECT_EQ(options.cache.view, CacheOutput::final);
    EXPECT_FALSE(options.cache.train_steps) << "nothing about training";
    EXPECT_EQ(options.width, RenderOptions().width);
    EXPECT_EQ(options.height, RenderOptions().height);
    EXPECT_GT(options.spp, spp);
    spp = options.spp;
  }
}

TEST(Presets, FramesHaveThreeQuartersOfTheSamples) {
  RenderOptions still, frames;
  apply_preset(CachePreset::standard, still);
  apply_preset_of_frames(CachePreset::standard, frames);
  EXPECT_EQ(4 * frames.spp, 3 * still.spp);
  EXPECT_EQ(4 * frames.spp_of_paths, 3 * still.spp_of_paths);
  EXPECT_EQ(frames.denoise.prefilter, Prefilter::fast);
  apply_preset_of_frames(CachePreset::final, frames);
  EXPECT_EQ(frames.spp, 36);
  apply_preset(CachePreset::paper_nrc, still);
  apply_preset_of_frames(CachePreset::paper_nrc, frames);
  EXPECT_EQ(frames.spp, still.spp) << "of a paper they are the same";
}

TEST(Presets, OtherOptionsStay) {
  for (const CachePreset preset : {CachePreset::bare, CachePreset::preview, CachePreset::standard,
                                   CachePreset::final, CachePreset::paper_nao, CachePreset::paper_nrc}) {
    RenderOptions options;
    options.seed = 5;
    options.max_depth = 3;
    options.threads = 2;
    options.camera.name = "north";
    options.environment.constant = Color(1.0f, 2.0f, 3.0f);
    options.aovs = {Aov::depth};
    options.region = {{1, 2, 3, 4}};
    apply_preset(preset, options);
    EXPECT_EQ(options.seed, 5u);
    EXPECT_EQ(options.max_depth, 3);
    EXPECT_EQ(options.threads, 2);
    EXPECT_EQ(options.camera.name, "north");
    EXPECT_TRUE((options.environment.constant == Color(1.0f, 2.0f, 3.0f)).all());
    EXPECT_EQ(options.aovs.size(), 1u);
    EXPECT_TRUE(options.region.has_value());
  }
}

}  // namespace
}  // namespace gatelight::renderer
