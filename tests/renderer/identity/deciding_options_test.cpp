#include "renderer/identity/deciding_options.h"

#include <gmock/gmock.h>

#include <functional>

namespace gatelight::renderer {
namespace {

std::string changed(const std::function<void(RenderOptions&, scene::Camera&)>& change,
                    Integrator integrator = Integrator::nrc) {
  RenderOptions options;
  options.integrator = integrator;
  scene::Camera camera;
  neural::Metadata metadata;
  add_texts(metadata, "option", deciding_options(options, camera, {{"isa", "avx2"}}));
  change(options, camera);
  return list_differences(metadata, "option", deciding_options(options, camera, {{"isa", "avx2"}}));
}

TEST(DecidingOptions, EachIsNamedWithBothValues) {
  using O = RenderOptions&;
  using C = scene::Camera&;
  const std::vector<std::pair<std::function<void(O, C)>, const char*>> cases = {
      {[](O o, C) { o.integrator = Integrator::path; }, "integrator: file nrc, expected path"},
      {[](O o, C) { o.height = 541; }, "size: file 960x540, expected 960x541"},
      {[](O o, C) {
         o.region = {{0, 1, 2, 3}};
       },
       "region: file all, expected 0,1,2,3"},
      {[](O o, C) { o.max_depth = 9; }, "max-depth: file 8, expected 9"},
      {[](O o, C) { o.min_depth = 9; }, "min-depth: file 2, expected 9"},
      {[](O o, C) { o.seed = 4294967295u; }, "seed: file 0, expected 4294967295"},
      {[](O o, C) { o.sampler = SamplerKind::independent; }, "sampler: file sobol, expected independent"},
      {[](O o, C) { o.filter = PixelFilter::box; }, "filter: file blackman-harris, expected box"},
      {[](O o, C) { o.filter_width = 0.1f; }, "filter-width: file 0, expected 0.1"},
      {[](O o, C) { o.mis = MisHeuristic::balance; }, "mis: file power, expected balance"},
      {[](O o, C) { o.direct = DirectLight::nee; }, "direct: file mis, expected nee"},
      {[](O o, C) { o.light_selection = LightSelection::power; }, "light-selection: file tree"},
      {[](O o, C) { o.clamp = 1.5f; }, "clamp: file 0, expected 1.5"},
      {[](O o, C) { o.ao_distance = 0.0f; }, "ao-distance: file auto, expected 0"},
      {[](O o, C) {
         o.aovs = {Aov::depth, Aov::variance};
       },
       "aov: file , expected depth,variance"},
      {[](O, C c) { c.transform(2, 3) = 1.0f; }, "camera: file 1,0,0,0,1,0,0,0,1,0,0,0 fov"},
      {[](O, C c) { c.vertical_fov = 1.25f; }, "expected 1,0,0,0,1,0,0,0,1,0,0,0 fov 1.25 aspect 0"},
      {[](O, C c) { c.orthographic = true; }, "orthographic 1,0"},
      {[](O o, C) { o.cache.train_steps = 7; }, "train-steps: file auto, expected 7"},
      {[](O o, C) { o.cache.batch = 7; }, "batch: file 4096, expected 7"},
      {[](O o, C) { o.cache.self_training.attenuation = 0.5f; }, "self-training-attenuation: file 1"},
      {[](O o, C) {
         o.cache.gate.stack = {0, 2};
       },
       "stack: file adaptive,adaptive/3,adaptive/9,adaptive/27, expected adaptive,2"},
      {[](O o, C) { o.cache.gate.rule = neural::ResolutionRule::paper; }, "resolution: file uniform"},
      {[](O o, C) { o.cache.encoding = neural::FeatureEncoding::hash_grid; },
       "encoding: file gate, expected hashgrid"},
      {[](O o, C) { o.cache.training.adam.epsilon = 1e-8f; }, "epsilon: file 1e-15, expected 1e-08"},
      {[](O o, C) { o.cache.training.average.features = false; }, "average: file on,on, expected on,off"},
      {[](O o, C) { o.cache.mlp.width = 64; }, "hidden: file 32, expected 64"},
      {[](O o, C) { o.cache.direction_input = false; }, "direction-input: file auto, expected off"},
      {[](O o, C) { o.cache.scout = false; }, "scout: file on, expected off"},
      {[](O o, C) { o.cache.holds = CacheHolds::all; }, "cache-holds: file no-delta, expected all"},
      {[](O o, C) { o.cache.query_at = QueryAt::spread; }, "query-at: file gather, expected spread"},
      {[](O o, C) { o.cache.view = CacheView::cache; }, "view: file final, expected cache"},
      {[](O o, C) { o.cache.cache_in = "old"; }, "cache-in: file none, expected old"},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_THAT(changed(cases[i].first), ::testing::HasSubstr(cases[i].second)) << "case " << i;
  }
}

TEST(DecidingOptions, WhatDecidesNoBitsIsNotAmongThem) {
  const auto change = [](RenderOptions& o, scene::Camera& c) {
    o.spp = 1000;
    o.time_limit_seconds = 5;
    o.threads = 3;
    o.nan_policy = NanPolicy::error;
    o.memory_limit_bytes = 1 << 30;
    o.isa = "avx2";
    o.camera.name = "by another name";
    o.environment.file = "moved.exr";
    o.cache.cache_out = "out";
    o.cache.train_seconds = 5;
    o.checkpoint = {"file", 1.0, true};
    c.name = "renamed";
  };
  EXPECT_EQ(changed(change), "");
}

TEST(DecidingOptions, ThoseOfTheCacheAreNotOfThePathTracer) {
  const auto change = [](RenderOptions& o, scene::Camera&) { o.cache.batch = 7; };
  EXPECT_NE(changed(change, Integrator::nao), "");
  EXPECT_EQ(changed(change, Integrator::path), "");
}

TEST(DecidingOptions, TheMachineIsNamed) {
  neural::Metadata metadata;
  add_texts(metadata, "option", deciding_options({}, {}, {{"isa", "avx2"}}));
  EXPECT_EQ(list_differences(metadata, "option", deciding_options({}, {}, {{"isa", "avx512"}})),
            "isa: file avx2, expected avx512");
}

}  // namespace
}  // namespace gatelight::renderer
