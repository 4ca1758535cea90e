// The flags of a cache set its options.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "apps/reports/recipe.h"
#include "apps/settings/help_format.h"
#include "tests/apps/settings/read_flags.h"

namespace gatelight::apps {
namespace {

using renderer::Aov;
using renderer::CacheOptions;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(CacheFlags, EachFlagOfLearningSetsItsMember) {
  const CacheOptions learning = read_cache(
      words_of("--train-steps 7 --train-time 2.5 --batch 100 --train-path-length 4 "
               "--samples-per-point 3 --training-points surface --candidates 16 --self-training 9 "
               "--self-training-vertices 5 --self-training-full 0.5 --self-training-attenuation 0.75 "
               "--learning-rate 0.5 --learning-decay 0 --loss l2 --update dense "
               "--feature-step per-triangle --average off"));
  EXPECT_EQ(learning.train_steps, 7);
  EXPECT_EQ(learning.train_seconds, 2.5);
  EXPECT_EQ(learning.batch, 100u);
  EXPECT_EQ(learning.path_length, 4);
  EXPECT_EQ(learning.samples_per_point, 3);
  EXPECT_EQ(learning.source, renderer::TrainingSource::surface);
  EXPECT_EQ(learning.candidates, 16);
  EXPECT_EQ(learning.self_training.start_step, 9);
  EXPECT_EQ(learning.self_training.vertices, 5);
  EXPECT_EQ(learning.self_training.full_fraction, 0.5f);
  EXPECT_EQ(learning.self_training.attenuation, 0.75f);
  EXPECT_EQ(learning.training.adam.learning_rate, 0.5f);
  EXPECT_EQ(learning.training.adam.decay_steps, 0.0f);
  EXPECT_EQ(learning.training.loss, neural::Loss::l2);
  EXPECT_EQ(learning.training.update, neural::FeatureUpdate::dense);
  EXPECT_EQ(learning.training.feature_step, neural::FeatureStep::per_triangle);
  EXPECT_FALSE(learning.training.average.network);
  EXPECT_FALSE(learning.training.average.features);
}

TEST(CacheFlags, EachFlagOfTheModelSetsItsMember) {
  const CacheOptions shape = read_cache(
      words_of("--features 4 --stack adaptive,8,adaptive/4 --resolution fixed:12 --max-resolution 16 "
               "--cluster off --storage per-triangle --cache-memory 1.5 "
               "--feature-precision fp16-only --hidden 64 --layers 5 --bias off --direction-input on "
               "--normal-input off --albedo-input on --scout off"));
  EXPECT_EQ(shape.encoding, neural::FeatureEncoding::gate);
  EXPECT_EQ(shape.gate.features, 4u);
  EXPECT_THAT(shape.gate.stack, ElementsAre(0, 8, neural::adaptive_part(4)));
  EXPECT_EQ(shape.gate.rule, neural::ResolutionRule::fixed);
  EXPECT_EQ(shape.gate.fixed_resolution, 12u);
  EXPECT_EQ(shape.gate.max_resolution, 16u);
  EXPECT_FALSE(shape.gate.cluster);
  EXPECT_EQ(shape.gate.storage, neural::NodeStorage::per_triangle);
  EXPECT_EQ(shape.memory_bytes, 1572864u);
  EXPECT_EQ(shape.training.precision, neural::FeaturePrecision::fp16);
  EXPECT_EQ(shape.mlp.width, 64u);
  EXPECT_EQ(shape.mlp.hidden_layers, 5u);
  EXPECT_FALSE(shape.mlp.biases);
  EXPECT_EQ(shape.direction_input, true);
  EXPECT_EQ(shape.normal_input, false);
  EXPECT_EQ(shape.albedo_input, true);
  EXPECT_FALSE(shape.scout);
  EXPECT_EQ(read_cache(words_of("--resolution paper --resolution-scale 3")).gate.resolution_scale, 3.0f);
  EXPECT_EQ(read_cache(words_of("--node-spacing 0.25")).node_spacing, 0.25f);
}

TEST(CacheFlags, EachFlagOfTheHashGridSetsItsMember) {
  const CacheOptions hash =
      read_cache(words_of("--encoding hashgrid --hash-levels 3 --hash-features 2 --hash-log2-size 12 "
                          "--hash-base 4 --hash-growth 1.5"));
  EXPECT_EQ(hash.encoding, neural::FeatureEncoding::hash_grid);
  EXPECT_EQ(hash.hash_grid.levels, 3u);
  EXPECT_EQ(hash.hash_grid.features, 2u);
  EXPECT_EQ(hash.hash_grid.log2_table_size, 12u);
  EXPECT_EQ(hash.hash_grid.base_resolution, 4u);
  EXPECT_EQ(hash.hash_grid.growth, 1.5f);
}

TEST(CacheFlags, EachFlagOfAnswersSetsItsMember) {
  const CacheOptions answers =
      read_cache(words_of("--cache-holds indirect --query-at spread --cache-roughness 0.5 "
                          "--spread-threshold 0.125 --query-precision bf16 --device vulkan:1 "
                          "--cache-in i.safetensors --cache-out o.safetensors"));
  EXPECT_EQ(answers.component, renderer::CachedComponent::indirect);
  EXPECT_EQ(answers.query_at, renderer::QueryAt::spread);
  EXPECT_EQ(answers.min_roughness, 0.5f);
  EXPECT_EQ(answers.spread_threshold, 0.125f);
  EXPECT_TRUE(answers.bf16_queries);
  EXPECT_EQ(answers.device, "vulkan:1");
  EXPECT_EQ(answers.cache_in, "i.safetensors");
  EXPECT_EQ(answers.cache_out, "o.safetensors");
  EXPECT_EQ(read_cache(words_of("--view cache")).view, renderer::CacheOutput::cache);
}

TEST(CacheFlags, AutoAndOffLeaveNumbersUnset) {
  const CacheOptions none = read_cache({"--train-steps", "auto", "--self-training", "off", "--node-spacing",
                                        "auto", "--normal-input", "auto"});
  EXPECT_EQ(none.train_steps, std::nullopt);
  EXPECT_LT(none.self_training.start_step, 0);
  EXPECT_EQ(none.node_spacing, std::nullopt);
  EXPECT_EQ(none.normal_input, std::nullopt);
}

TEST(CacheFlags, DefaultsAreThoseOfTheRendererAndShownInTheHelp) {
  CLI::App app("");
  RenderSettings settings;
  add_flags(app, option_table(settings));
  // Each default of the help, given as a value, changes nothing.
  Words words = {"--integrator", "nrc"};
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    if (!cache_names().contains(name_of(*option)) || option->get_default_str().empty()) continue;
    if (name.starts_with("--hash") || name == "--resolution-scale" || name == "--spread-threshold" ||
        name == "--samples-from-step")
      continue;
    words.insert(words.end(), {name, option->get_default_str()});
  }
  EXPECT_GT(words.size(), 60u);
  EXPECT_EQ(resolved_options(read_flags(words)), resolved_options(read_flags({"--integrator", "nrc"})));
}

TEST(CacheFlags, EveryFlagIsExplainedInAGroup) {
  CLI::App app("");
  app.formatter(make_help_formatter());
  RenderSettings settings;
  add_flags(app, option_table(settings));
  const std::string help = app.help();
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() || option == app.get_help_ptr()) continue;
    EXPECT_THAT(help, HasSubstr("  " + option->get_name(false, true) + " " + option->get_type_name()));
    EXPECT_GE(option->get_description().size(), 10u) << option->get_name();
    EXPECT_NE(option->get_group(), "Options") << option->get_name();
    EXPECT_EQ(option->get_type_name().find(' '), std::string::npos) << option->get_name();
  }
  for (const char* group : {"Files:", "Cache, learning:", "Cache, model:", "Cache, answers:"}) {
    EXPECT_THAT(help, HasSubstr(std::string("\n") + group + "\n"));
  }
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST(CacheFlags, AovAllSelectsTheLayersOfTheIntegrator) {
  using Needs = renderer::AovNeeds;
  const auto all_that_need = [](std::initializer_list<Needs> needs) {
    std::vector<Aov> aovs;
    for (const renderer::AovInfo& row : renderer::kAovs) {
      if (std::find(needs.begin(), needs.end(), row.needs) != needs.end()) aovs.push_back(row.aov);
    }
    return aovs;
  };
  const std::vector<Aov> path = read_flags({"--aov", "all"}).render.aovs;
  const std::vector<Aov> cache = read_flags({"--aov", "all", "--integrator", "nrc"}).render.aovs;
  EXPECT_EQ(path, all_that_need({Needs::nothing, Needs::light}));
  EXPECT_EQ(cache, all_that_need({Needs::nothing, Needs::light, Needs::cache, Needs::radiance_cache,
                                  Needs::mesh_colors}));
  const std::vector<Aov> occlusion = read_flags({"--aov", "all", "--integrator", "nao"}).render.aovs;
  EXPECT_EQ(occlusion, all_that_need({Needs::nothing, Needs::cache, Needs::mesh_colors}));
  EXPECT_THAT(occlusion, Not(Contains(Aov::cache_error)));
  const std::vector<Aov> hash =
      read_flags(with_cache({"--aov", "all", "--encoding", "hashgrid"})).render.aovs;
  EXPECT_EQ(hash, all_that_need({Needs::nothing, Needs::light, Needs::cache, Needs::radiance_cache}));
  EXPECT_THAT(hash, Not(Contains(Aov::resolution)));
  EXPECT_THAT(read_flags({"--aov", "resolution,albedo", "--integrator", "nao"}).render.aovs,
              ElementsAre(Aov::albedo, Aov::resolution));
}

TEST(CacheFlags, OcclusionHasItsOwnLossUnlessOneIsGiven) {
  EXPECT_EQ(read_flags({"--integrator", "nao"}).render.cache.training.loss, neural::Loss::l2);
  EXPECT_EQ(read_flags({"--integrator", "nao", "--loss", "relative-l2"}).render.cache.training.loss,
            neural::Loss::relative_l2);
  EXPECT_EQ(read_cache({}).training.loss, neural::Loss::relative_l2);
  EXPECT_EQ(resolved_options(read_flags({"--integrator", "nao"}))["loss"], "l2");
}

}  // namespace
}  // namespace gatelight::apps
