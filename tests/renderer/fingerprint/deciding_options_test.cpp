#include "renderer/fingerprint/deciding_options.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using tests::expect_message;

std::string changed(const std::function<void(RenderOptions&, scene::Camera&)>& change,
                    Integrator integrator = Integrator::nrc) {
  RenderOptions options;
  options.integrator = integrator;
  scene::Camera camera;
  Metadata metadata;
  add_texts(metadata, "option", deciding_options(options, camera, {{"isa", "avx2"}}));
  change(options, camera);
  return list_differences(metadata, "option", deciding_options(options, camera, {{"isa", "avx2"}}));
}

TEST(DecidingOptions, EachIsNamedWithBothValues) {
  using O = RenderOptions&;
  using C = scene::Camera&;
  const std::vector<std::pair<std::function<void(O, C)>, tests::NameList>> cases = {
      {[](O o, C) { o.integrator = Integrator::path; }, {"integrator", "nrc", "path"}},
      {[](O o, C) { o.height = 541; }, {"size", "960x540", "960x541"}},
      {[](O o, C) {
         o.region = {{0, 1, 2, 3}};
       },
       {"region", "all", "0,1,2,3"}},
      {[](O o, C) { o.max_depth = 9; }, {"max-depth", "none", "9"}},
      {[](O o, C) { o.min_depth = 9; }, {"min-depth", "2", "9"}},
      {[](O o, C) { o.seed = 4294967295u; }, {"seed", "0", "4294967295"}},
      {[](O o, C) { o.sampler = SamplerKind::independent; }, {"sampler", "sobol", "independent"}},
      {[](O o, C) { o.filter = PixelFilter::box; }, {"filter", "blackman-harris", "box"}},
      {[](O o, C) { o.filter_width = 0.1f; }, {"filter-width", "0", "0.1"}},
      {[](O o, C) { o.mis = MisHeuristic::balance; }, {"mis", "power", "balance"}},
      {[](O o, C) { o.direct = DirectLight::nee; }, {"direct", "mis", "nee"}},
      {[](O o, C) { o.light_selection = LightSelection::power; }, {"light-selection", "tree", "power"}},
      {[](O o, C) { o.watertight = false; }, {"watertight", "on", "off"}},
      {[](O o, C) { o.denoise.denoiser = DenoiserKind::oidn; }, {"denoiser", "none", "oidn"}},
      {[](O o, C) { o.denoise.prefilter = Prefilter::fast; }, {"prefilter", "accurate", "fast"}},
      {[](O o, C) { o.denoise.supersampling = 2; }, {"supersampling", "1", "2"}},
      {[](O o, C) { o.clamp = 1.5f; }, {"clamp", "0", "1.5"}},
      {[](O o, C) { o.ao_distance = 0.0f; }, {"ao-distance", "auto", "0"}},
      {[](O o, C) {
         o.aovs = {Aov::depth, Aov::variance};
       },
       {"aov", "depth,variance"}},
      {[](O o, C) {
         o.light_groups = {{"key", {"lamp*", "sun"}}};
       },
       {"light-groups", "none", "key=lamp*,sun"}},
      {[](O, C c) { c.transform(2, 3) = 1.0f; }, {"camera", "1,0,0,0,1,0,0,0,1,0,0,0"}},
      {[](O, C c) { c.vertical_fov = 1.25f; }, {"camera", "1.25"}},
      {[](O, C c) { c.orthographic = true; }, {"camera", "orthographic"}},
      {[](O o, C) { o.cache.train_steps = 7; }, {"train-steps", "auto", "7"}},
      {[](O o, C) { o.cache.batch = 7; }, {"batch", "4096", "7"}},
      {[](O o, C) { o.cache.self_training.attenuation = 0.5f; }, {"self-training-attenuation", "1", "0.5"}},
      {[](O o, C) {
         o.cache.gate.stack = {0, 2};
       },
       {"stack", "adaptive,adaptive/3,adaptive/9,adaptive/27", "adaptive,2"}},
      {[](O o, C) { o.cache.gate.rule = neural::ResolutionRule::paper; }, {"resolution", "uniform", "paper"}},
      {[](O o, C) { o.cache.encoding = neural::FeatureEncoding::hash_grid; },
       {"encoding", "gate", "hashgrid"}},
      {[](O o, C) { o.cache.training.adam.epsilon = 1e-8f; }, {"epsilon", "1e-15", "1e-08"}},
      {[](O o, C) { o.cache.training.average.features = false; }, {"average-features", "on", "off"}},
      {[](O o, C) { o.cache.mlp.width = 64; }, {"hidden", "32", "64"}},
      {[](O o, C) { o.cache.direction_input = false; }, {"direction-input", "auto", "off"}},
      {[](O o, C) { o.cache.scout = false; }, {"scout", "on", "off"}},
      {[](O o, C) { o.cache.component = CachedComponent::all; }, {"cache-holds", "no-delta", "all"}},
      {[](O o, C) { o.cache.query_at = QueryAt::spread; }, {"query-at", "gather", "spread"}},
      {[](O o, C) { o.cache.view = CacheOutput::cache; }, {"view", "final", "cache"}},
      {[](O o, C) { o.cache.cache_in = "old"; }, {"cache-in", "none", "old"}},
  };
  for (const auto& [change, names] : cases) expect_message(changed(change), names);
}

TEST(DecidingOptions, OptionsThatDecideNoBitsAreNotAmongThem) {
  const auto change = [](RenderOptions& o, scene::Camera& c) {
    o.spp = 1000;
    o.time_limit_seconds = 5;
    o.max_error = 0.1;
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

TEST(DecidingOptions, OptionsOfTheCacheDoNotDecideThePathTracersPicture) {
  const auto change = [](RenderOptions& o, scene::Camera&) { o.cache.batch = 7; };
  EXPECT_NE(changed(change, Integrator::nao), "");
  EXPECT_EQ(changed(change, Integrator::path), "");
}

TEST(DecidingOptions, TheInstructionSetIsNamed) {
  Metadata metadata;
  add_texts(metadata, "option", deciding_options({}, {}, {{"isa", "avx2"}}));
  EXPECT_EQ(list_differences(metadata, "option", deciding_options({}, {}, {{"isa", "avx512"}})),
            "isa: file avx2, expected avx512");
}

}  // namespace
}  // namespace gatelight::renderer
