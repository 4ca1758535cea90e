// The flags of a cache, read without a scene.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/reports/recipe.h"
#include "apps/settings/complete_settings.h"
#include "apps/settings/config_file.h"
#include "apps/settings/flags.h"
#include "apps/settings/help_format.h"
#include "apps/settings/option_table.h"
#include "apps/terminal/errors.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using renderer::Aov;
using renderer::CacheOptions;
using renderer::Integrator;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Words = std::vector<std::string>;
using tests::expect_message;
using tests::TemporaryFolder;

/// Settings of `gatelight render room.glb -o a.exr WORDS`.
RenderSettings read(Words words) {
  CLI::App root("", "gatelight");
  root.fallthrough();
  accept_config_file(root);
  CLI::App* app = root.add_subcommand("render", "");
  RenderSettings settings;
  add_flags(*app, option_table(settings));
  words.insert(words.begin(), {"render", "room.glb", "-o", "a.exr"});
  std::reverse(words.begin(), words.end());
  root.parse(words);
  finish_flags(*app, settings);
  complete_settings(settings);
  return settings;
}

Words with_cache(Words words) {
  words.insert(words.begin(), {"--integrator", "nrc"});
  return words;
}

CacheOptions read_cache(const Words& words) {
  return read(with_cache(words)).render.cache;
}

std::string refusal(const Words& words) {
  return tests::refusal<UsageError>([&] { read(words); });
}

std::set<std::string> cache_flags() {
  RenderSettings settings;
  std::set<std::string> flags;
  for (const Option& option : option_table(settings)) {
    if (option.of_cache) flags.insert(option.flag());
  }
  return flags;
}

TEST(CacheFlags, EachFlagSetsItsMember) {
  const CacheOptions learning = read_cache({"--train-steps",
                                            "7",
                                            "--train-time",
                                            "2.5",
                                            "--batch",
                                            "100",
                                            "--train-path-length",
                                            "4",
                                            "--samples-per-point",
                                            "3",
                                            "--training-points",
                                            "surface",
                                            "--candidates",
                                            "16",
                                            "--self-training",
                                            "9",
                                            "--self-training-vertices",
                                            "5",
                                            "--self-training-full",
                                            "0.5",
                                            "--self-training-attenuation",
                                            "0.75",
                                            "--learning-rate",
                                            "0.5",
                                            "--learning-decay",
                                            "0",
                                            "--loss",
                                            "l2",
                                            "--update",
                                            "dense",
                                            "--feature-step",
                                            "per-triangle",
                                            "--average",
                                            "off"});
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

  const CacheOptions shape = read_cache({"--features",
                                         "4",
                                         "--stack",
                                         "adaptive,8,adaptive/4",
                                         "--resolution",
                                         "fixed:12",
                                         "--max-resolution",
                                         "16",
                                         "--cluster",
                                         "off",
                                         "--storage",
                                         "per-triangle",
                                         "--cache-memory",
                                         "1.5",
                                         "--feature-precision",
                                         "fp16-only",
                                         "--hidden",
                                         "64",
                                         "--layers",
                                         "5",
                                         "--bias",
                                         "off",
                                         "--direction-input",
                                         "on",
                                         "--normal-input",
                                         "off",
                                         "--albedo-input",
                                         "on",
                                         "--scout",
                                         "off"});
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
  EXPECT_EQ(read_cache({"--resolution", "paper", "--resolution-scale", "3"}).gate.resolution_scale, 3.0f);
  EXPECT_EQ(read_cache({"--node-spacing", "0.25"}).node_spacing, 0.25f);

  const CacheOptions hash =
      read_cache({"--encoding", "hashgrid", "--hash-levels", "3", "--hash-features", "2", "--hash-log2-size",
                  "12", "--hash-base", "4", "--hash-growth", "1.5"});
  EXPECT_EQ(hash.encoding, neural::FeatureEncoding::hash_grid);
  EXPECT_EQ(hash.hash_grid.levels, 3u);
  EXPECT_EQ(hash.hash_grid.features, 2u);
  EXPECT_EQ(hash.hash_grid.log2_table_size, 12u);
  EXPECT_EQ(hash.hash_grid.base_resolution, 4u);
  EXPECT_EQ(hash.hash_grid.growth, 1.5f);

  const CacheOptions answers =
      read_cache({"--cache-holds", "indirect", "--query-at", "spread", "--cache-roughness", "0.5",
                  "--spread-threshold", "0.125", "--query-precision", "bf16", "--device", "vulkan:1",
                  "--cache-in", "i.safetensors", "--cache-out", "o.safetensors"});
  EXPECT_EQ(answers.holds, renderer::CacheHolds::indirect);
  EXPECT_EQ(answers.query_at, renderer::QueryAt::spread);
  EXPECT_EQ(answers.min_roughness, 0.5f);
  EXPECT_EQ(answers.spread_threshold, 0.125f);
  EXPECT_TRUE(answers.bf16_queries);
  EXPECT_EQ(answers.device, "vulkan:1");
  EXPECT_EQ(answers.cache_in, "i.safetensors");
  EXPECT_EQ(answers.cache_out, "o.safetensors");
  EXPECT_EQ(read_cache({"--view", "cache"}).view, renderer::CacheView::cache);
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
    if (!cache_flags().contains(name) || option->get_default_str().empty()) continue;
    if (name.starts_with("--hash") || name == "--resolution-scale" || name == "--spread-threshold" ||
        name == "--samples-from-step")
      continue;
    words.insert(words.end(), {name, option->get_default_str()});
  }
  EXPECT_GT(words.size(), 60u);
  EXPECT_EQ(resolved_options(read(words)), resolved_options(read({"--integrator", "nrc"})));
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
  }
  for (const char* group : {"Files:", "Cache, learning:", "Cache, what it is:", "Cache, answers:"}) {
    EXPECT_THAT(help, HasSubstr(std::string("\n") + group + "\n"));
  }
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST(Presets, EveryFlagOverridesThemInAnyOrder) {
  const Words flags = {"--spp",        "3", "--size", "64x32", "--query-at", "gather",
                       "--candidates", "2", "--aov",  "all"};
  // The paper's view is the bare answer, where gathering has no effect.
  Words before = {"--preset", "paper-nrc", "--view", "final"};
  before.insert(before.end(), flags.begin(), flags.end());
  Words after = flags;
  after.insert(after.end(), {"--view", "final", "--preset", "paper-nrc"});
  const RenderSettings first = read(before);
  EXPECT_EQ(first.render.integrator, Integrator::nrc);
  EXPECT_EQ(first.render.spp, 3);
  EXPECT_EQ(first.render.width, 64);
  EXPECT_EQ(first.render.cache.query_at, renderer::QueryAt::gather);
  EXPECT_EQ(first.render.cache.candidates, 2);
  EXPECT_EQ(first.render.cache.batch, 49152u) << "the preset's";
  EXPECT_EQ(first.render.cache.holds, renderer::CacheHolds::all) << "the preset's";
  EXPECT_EQ(first.outputs, Words{"a.exr"});
  EXPECT_EQ(resolved_options(first), resolved_options(read(after)));
}

TEST(Presets, EveryFlagOfAConfigFileOverridesThem) {
  TemporaryFolder folder;
  const std::string flags = "spp = 3\ncandidates = 2\nstack = [\"adaptive\", 4]\nreproducible = true\n";
  const std::string without = folder.write("w.toml", flags);
  const std::string first = folder.write("f.toml", "preset = \"paper-nao\"\n" + flags);
  const std::string last = folder.write("l.toml", flags + "preset = \"paper-nao\"\n");
  const RenderSettings settings = read({"--preset", "paper-nao", "--config", without});
  EXPECT_EQ(settings.render.integrator, Integrator::nao);
  EXPECT_EQ(settings.render.width, 1920);
  EXPECT_EQ(settings.render.spp, 3);
  EXPECT_EQ(settings.render.cache.candidates, 2);
  EXPECT_EQ(settings.render.cache.gate.features, 2u) << "the preset's";
  EXPECT_THAT(settings.render.cache.gate.stack, ElementsAre(0, 4));
  EXPECT_TRUE(settings.reproducible);
  const ordered_json options = resolved_options(settings);
  EXPECT_EQ(resolved_options(read({"--config", first})), options);
  EXPECT_EQ(resolved_options(read({"--config", last})), options);
  // The command line's preset replaces the file's, and the command line's flags win.
  const RenderSettings both = read({"--spp", "9", "--preset", "preview", "--config", last});
  EXPECT_EQ(both.render.integrator, Integrator::nrc);
  EXPECT_EQ(both.render.spp, 9);
  EXPECT_EQ(both.render.cache.candidates, 2);
}

TEST(Presets, ChooseTheIntegratorUnlessItIsGiven) {
  EXPECT_EQ(read({"--preset", "final"}).render.integrator, Integrator::nrc);
  EXPECT_EQ(read({"--preset", "paper-nrc", "--integrator", "nao"}).render.integrator, Integrator::nao);
  EXPECT_TRUE(read({"--preset", "final"}).render.choose_integrator);
  EXPECT_FALSE(read({"--preset", "final", "--integrator", "nrc"}).render.choose_integrator);
  EXPECT_FALSE(read({"--preset", "final", "--train-steps", "9"}).render.choose_integrator)
      << "a flag of the cache implies one";
  // Paths get more samples in the same time, unless their number is given.
  for (const char* const flag : {"--integrator=path", "--light-groups=a=*"}) {
    const RenderSettings paths = read({"--preset", "standard", flag});
    EXPECT_EQ(paths.render.integrator, Integrator::path);
    EXPECT_FALSE(paths.render.choose_integrator);
    EXPECT_EQ(paths.render.spp, 12);
    EXPECT_EQ(paths.render.denoise.denoiser, renderer::DenoiserKind::automatic);
  }
  EXPECT_EQ(read({"--preset", "standard", "--integrator", "path", "--spp", "5"}).render.spp, 5);
  const RenderSettings chosen = read({"--integrator", "auto"});
  EXPECT_TRUE(chosen.render.choose_integrator);
  EXPECT_EQ(chosen.render.integrator, Integrator::nrc);
}

TEST(CacheFlags, AreRefusedWithoutACache) {
  EXPECT_GT(cache_flags().size(), 40u);
  for (const char* flag : {"--cache-in", "--cache-out", "--train-steps", "--device", "--cache-memory"}) {
    EXPECT_TRUE(cache_flags().contains(flag)) << flag;
  }
  for (const char* flag : {"--spp", "--integrator", "--isa", "--checkpoint"}) {
    EXPECT_FALSE(cache_flags().contains(flag)) << flag;
  }
  expect_message(refusal({"--batch", "100"}), {"--batch", "path", "nao", "nrc"});
  expect_message(refusal({"--integrator", "ao", "--cache-in", "c"}), {"--cache-in", "ao"});
  expect_message(refusal({"--aov", "albedo,training-count"}), {"--aov", "training-count", "path"});
}

TEST(CacheFlags, AovAllSelectsTheLayersOfTheIntegrator) {
  const std::vector<Aov> path = read({"--aov", "all"}).render.aovs;
  const std::vector<Aov> cache = read({"--aov", "all", "--integrator", "nrc"}).render.aovs;
  EXPECT_EQ(path.size(), 12u);
  EXPECT_EQ(cache.size(), 18u);
  const std::vector<Aov> occlusion = read({"--aov", "all", "--integrator", "nao"}).render.aovs;
  EXPECT_EQ(occlusion.size(), 16u);
  EXPECT_THAT(occlusion, Not(Contains(Aov::cache_error)));
  const std::vector<Aov> hash = read(with_cache({"--aov", "all", "--encoding", "hashgrid"})).render.aovs;
  EXPECT_EQ(hash.size(), 15u);
  EXPECT_EQ(hash.back(), Aov::cache_error);
  EXPECT_THAT(read({"--aov", "resolution,albedo", "--integrator", "nao"}).render.aovs,
              ElementsAre(Aov::albedo, Aov::resolution));
}

TEST(CacheFlags, FlagsOfAnotherEncodingOrRuleAreRefused) {
  expect_message(refusal(with_cache({"--hash-levels", "4"})), {"--hash-levels", "--encoding hashgrid"});
  expect_message(refusal(with_cache({"--encoding", "hashgrid", "--stack", "1"})),
                 {"--stack", "--encoding gate"});
  expect_message(refusal(with_cache({"--resolution-scale", "2"})),
                 {"--resolution-scale", "--resolution paper"});
  expect_message(refusal(with_cache({"--resolution", "paper", "--node-spacing", "2"})),
                 {"--node-spacing", "--resolution uniform"});
  expect_message(refusal(with_cache({"--encoding", "hashgrid", "--candidates", "4"})),
                 {"--candidates", "--encoding gate"});
  EXPECT_EQ(refusal(with_cache({"--encoding", "hashgrid", "--candidates", "1"})), "");
  // A preset's values are not flags.
  const RenderSettings preset = read({"--preset", "paper-nrc", "--encoding", "hashgrid"});
  EXPECT_EQ(preset.render.cache.training.feature_step, neural::FeatureStep::per_node);
  EXPECT_EQ(preset.render.cache.candidates, 1);
  EXPECT_EQ(read({"--preset", "paper-nrc"}).render.cache.candidates, 16);
}

TEST(CacheFlags, RadianceFlagsAreRefusedWithOcclusion) {
  const std::vector<Words> cases = {
      {"--cache-holds", "all"},
      {"--query-at", "primary"},
      {"--view", "final"},
      {"--self-training", "9"},
      {"--self-training-vertices", "5"},
      {"--self-training-full", "0.5"},
      {"--train-path-length", "4"},
      {"--self-training-attenuation", "0.5"},
      {"--cache-roughness", "0.25"},
      {"--spread-threshold", "0.5"},
      {"--albedo-input", "on"},
      {"--direction-input", "on"},
  };
  for (Words words : cases) {
    const std::string flag = words.front();
    words.insert(words.begin(), {"--integrator", "nao"});
    expect_message(refusal(words), {flag, "--integrator nrc"});
    EXPECT_FALSE(resolved_options(read({"--integrator", "nao"})).contains(flag.substr(2))) << flag;
  }
  EXPECT_EQ(refusal({"--integrator", "nao", "--encoding", "hashgrid", "--albedo-input", "on"}), "");
}

TEST(CacheFlags, FlagsWithoutEffectBesideOthersAreRefused) {
  expect_message(refusal(with_cache({"--spread-threshold", "0.5"})),
                 {"--spread-threshold", "--query-at spread"});
  for (const char* flag :
       {"--self-training-vertices", "--self-training-full", "--self-training-attenuation"}) {
    expect_message(refusal(with_cache({"--self-training", "off", flag, "1"})),
                   {flag, "--self-training STEP"});
    EXPECT_EQ(refusal(with_cache({"--self-training", "0", flag, "1"})), "");
  }
  for (const char* place : {"gather", "spread"}) {
    expect_message(refusal(with_cache({"--view", "cache", "--query-at", place})),
                   {"--query-at", "--view final"});
  }
  // The settings say where the bare answer is queried.
  EXPECT_EQ(read_cache({"--view", "cache"}).query_at, renderer::QueryAt::primary);
  EXPECT_EQ(read_cache({"--view", "cache", "--query-at", "none"}).query_at, renderer::QueryAt::none);
}

TEST(CacheFlags, OcclusionHasItsOwnLossUnlessOneIsGiven) {
  EXPECT_EQ(read({"--integrator", "nao"}).render.cache.training.loss, neural::Loss::l2);
  EXPECT_EQ(read({"--integrator", "nao", "--loss", "relative-l2"}).render.cache.training.loss,
            neural::Loss::relative_l2);
  EXPECT_EQ(read_cache({}).training.loss, neural::Loss::relative_l2);
  EXPECT_EQ(resolved_options(read({"--integrator", "nao"}))["loss"], "l2");
}

TEST(CacheFlags, LayersThatWouldBeBlackAreRefused) {
  expect_message(refusal({"--integrator", "nao", "--aov", "cache-error"}),
                 {"--aov", "cache-error", "--integrator nrc"});
  for (const char* layer : {"training-count", "resolution", "nearest-node"}) {
    expect_message(refusal(with_cache({"--encoding", "hashgrid", "--aov", layer})),
                   {"--aov", layer, "--encoding gate"});
  }
}

TEST(CheckpointFlags, NeedAFile) {
  expect_message(refusal({"--resume"}), {"--resume", "--checkpoint"});
  expect_message(refusal({"--checkpoint-every", "5"}), {"--checkpoint-every", "--checkpoint"});
  const renderer::CheckpointOptions options =
      read({"--resume", "--checkpoint-every", "5", "--checkpoint", "c.gatelight"}).render.checkpoint;
  EXPECT_EQ(options.file, "c.gatelight");
  EXPECT_EQ(options.every_seconds, 5.0);
  EXPECT_TRUE(options.resume);
  EXPECT_EQ(read({"--checkpoint", "c"}).render.checkpoint.every_seconds, 60.0);
}

TEST(FileNames, NoFlagWritesAFileThatAnotherReadsOrWrites) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "d");
  std::filesystem::create_directory_symlink("d", folder / "dl");
  std::filesystem::create_symlink("d/b.exr", folder / "link.exr");
  const std::string inside = (folder / "d/b.exr").string();
  const std::vector<std::pair<Words, tests::NameList>> cases = {
      {{"--checkpoint", "a.exr"}, {"--checkpoint", "a.exr", "--output"}},
      {{"--stats", "./a.exr"}, {"--stats", "./a.exr", "--output"}},
      {{"-o", "a.exr"}, {"--output", "a.exr"}},
      {{"-o", inside, "--checkpoint", (folder / "dl/b.exr").string()},
       {"--checkpoint", "dl/b.exr", "--output"}},
      {{"-o", inside, "-o", (folder / "link.exr").string()}, {"--output", "link.exr"}},
      {{"--stats", "room.glb"}, {"--stats", "room.glb", "SCENE"}},
      {{"--checkpoint", "room.glb"}, {"--checkpoint", "room.glb", "SCENE"}},
      {{"--environment", "sky.exr", "-o", "sky.exr"}, {"--output", "sky.exr", "--environment"}},
      {with_cache({"--cache-in", "c", "--stats", "c"}), {"--stats", "c", "--cache-in"}},
      {with_cache({"--cache-out", "room.glb"}), {"--cache-out", "room.glb", "SCENE"}},
      {with_cache({"--cache-in", "room.glb", "--cache-out", "room.glb"}),
       {"--cache-out", "room.glb", "SCENE"}},
  };
  for (const auto& [words, names] : cases) expect_message(refusal(words), names);
  EXPECT_EQ(refusal(with_cache({"--cache-in", "c", "--cache-out", "c"})), "") << "trained further";
  EXPECT_EQ(refusal({"--stats", "-"}), "");
}

TEST(Recipe, CanBePassedBackAsFlags) {
  const std::vector<Words> cases = {
      {"--size",        "64x32",      "--region",      "1,2,3,4", "--spp", "3",
       "--seed",        "4294967295", "--aov",         "all",     "--eye", "1,-2.5,3",
       "--target",      "0,0.1,0",    "--environment", "0.1,2,3", "--fov", "30.1",
       "--ao-distance", "inf",        "--exposure",    "-1.5",    "--exr", "float",
       "--scene-index", "-1",         "--missing",     "warn"},
      {"--camera", "front", "--environment", "sky.exr", "--time-limit", "0.5", "--checkpoint", "c"},
      {"--integrator", "nrc"},
      {"--preset", "paper-nao"},
      {"--preset", "paper-nrc", "--encoding", "hashgrid", "--cache-memory", "0.1"},
      {"--preset", "paper-nao", "--encoding", "hashgrid"},
      {"--integrator", "nrc", "--view", "cache"},
      {"--integrator", "nrc", "--query-at", "spread"},
      {"--preset", "preview", "--node-spacing", "0.1", "--self-training", "off", "--train-steps", "12"},
      {"--integrator", "nao", "--resolution", "fixed:3", "--stack", "adaptive,adaptive/3,2", "--average",
       "off", "--query-precision", "bf16", "--learning-rate", "0.003", "--cache-in", "i"},
  };
  for (const Words& words : cases) {
    RenderSettings settings = read(words);
    settings.preset.reset();
    const ordered_json options = resolved_options(settings);
    Words again;
    for (const Option& option : option_table(settings)) {
      if (options.contains(option.name) && option.read && !option.text().empty())
        again.push_back(option.flag() + "=" + option.text());
    }
    EXPECT_GT(again.size(), 25u);
    EXPECT_EQ(resolved_options(read(again)), options);
  }
}

TEST(CacheRecipe, ExistsOnlyWithACache) {
  const ordered_json path = resolved_options(read({}));
  const ordered_json cache =
      resolved_options(read({"--integrator", "nrc", "--cache-out", "o", "--cache-roughness", "0.3"}));
  EXPECT_FALSE(path.contains("batch"));
  EXPECT_FALSE(path.contains("train-steps"));
  EXPECT_EQ(cache["train-steps"], "auto");
  EXPECT_EQ(cache["cache-roughness"], json(0.3)) << "the digits of a float";
  EXPECT_EQ(cache["cache-out"], "o");
  const ordered_json reproducible = resolved_options(
      read({"--preset", "final", "--cache-out", "o", "--checkpoint", "c", "--reproducible"}));
  for (const char* key : {"preset", "cache-out", "checkpoint"})
    EXPECT_FALSE(reproducible.contains(key)) << key;
}

}  // namespace
}  // namespace gatelight::apps
