// Flags that have no effect, or would destroy a file, are refused.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/reports/recipe.h"
#include "tests/apps/settings/read_flags.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using tests::expect_parts;
using tests::TemporaryFolder;

TEST(RefusedFlags, CacheFlagsAreRefusedWithoutACache) {
  EXPECT_GT(cache_names().size(), 40u);
  for (const char* name : {"cache-in", "cache-out", "train-steps", "device", "cache-memory"}) {
    EXPECT_TRUE(cache_names().contains(name)) << name;
  }
  for (const char* name : {"spp", "integrator", "isa", "checkpoint"}) {
    EXPECT_FALSE(cache_names().contains(name)) << name;
  }
  expect_parts(refused_flags({"--batch", "100"}), {"batch", "", "'path'", "`integrator` nao or nrc"});
  expect_parts(refused_flags({"--integrator", "ao", "--cache-in", "c"}),
               {"cache-in", "", "'ao'", "`integrator`"});
  expect_parts(refused_flags({"--aov", "albedo,training-count"}),
               {"aov", "training-count", "'path'", "`integrator`"});
}

TEST(RefusedFlags, FlagsOfAnotherEncodingOrRuleAreRefused) {
  expect_parts(refused_flags(with_cache({"--hash-levels", "4"})),
               {"hash-levels", "", "", "`encoding` hashgrid"});
  expect_parts(refused_flags(with_cache({"--encoding", "hashgrid", "--stack", "1"})),
               {"stack", "", "", "`encoding` gate"});
  expect_parts(refused_flags(with_cache({"--resolution-scale", "2"})),
               {"resolution-scale", "", "", "`resolution` paper"});
  expect_parts(refused_flags(with_cache({"--resolution", "paper", "--node-spacing", "2"})),
               {"node-spacing", "", "", "`resolution` uniform"});
  expect_parts(refused_flags(with_cache({"--encoding", "hashgrid", "--candidates", "4"})),
               {"candidates", "", "", "`encoding` gate"});
  EXPECT_EQ(refused_flags(with_cache({"--encoding", "hashgrid", "--candidates", "1"})).option, "");
  // A preset's values are not flags.
  const RenderSettings preset = read_flags({"--preset", "paper-nrc", "--encoding", "hashgrid"});
  EXPECT_EQ(preset.render.cache.training.feature_step, neural::FeatureStep::per_node);
  EXPECT_EQ(preset.render.cache.candidates, 1);
  EXPECT_EQ(read_flags({"--preset", "paper-nrc"}).render.cache.candidates, 16);
}

TEST(RefusedFlags, AnAnimationNeedsATime) {
  expect_parts(refused_flags({"--animation", "walk"}), {"animation", "", "", "`time`"});
  EXPECT_EQ(refused_flags({"--animation", "walk", "--time", "0"}).option, "");
  EXPECT_EQ(read_flags({"--time", "-2.5"}).load.time, -2.5);
  EXPECT_FALSE(read_flags({}).load.time);
}

TEST(RefusedFlags, RadianceFlagsAreRefusedWithOcclusion) {
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
    expect_parts(refused_flags(words), {flag.substr(2), "", "", "`integrator` nrc"});
    EXPECT_FALSE(resolved_options(read_flags({"--integrator", "nao"})).contains(flag.substr(2))) << flag;
  }
  EXPECT_EQ(refused_flags({"--integrator", "nao", "--encoding", "hashgrid", "--albedo-input", "on"}).option,
            "");
}

TEST(RefusedFlags, FlagsWithoutEffectBesideOthersAreRefused) {
  expect_parts(refused_flags(with_cache({"--spread-threshold", "0.5"})),
               {"spread-threshold", "", "", "`query-at` spread"});
  for (const char* flag :
       {"--self-training-vertices", "--self-training-full", "--self-training-attenuation"}) {
    expect_parts(refused_flags(with_cache({"--self-training", "off", flag, "1"})),
                 {flag + 2, "", "", "`self-training` STEP"});
    EXPECT_EQ(refused_flags(with_cache({"--self-training", "0", flag, "1"})).option, "");
  }
  for (const char* place : {"gather", "spread"}) {
    expect_parts(refused_flags(with_cache({"--view", "cache", "--query-at", place})),
                 {"query-at", "", "", "`view` final"});
  }
  // The settings say where the bare answer is queried.
  EXPECT_EQ(read_cache({"--view", "cache"}).query_at, renderer::QueryAt::primary);
  EXPECT_EQ(read_cache({"--view", "cache", "--query-at", "none"}).query_at, renderer::QueryAt::none);
}

TEST(RefusedFlags, LayersThatWouldBeBlackAreRefused) {
  expect_parts(refused_flags({"--integrator", "nao", "--aov", "cache-error"}),
               {"aov", "cache-error", "'nao'", "`integrator` nrc"});
  for (const char* layer : {"training-count", "resolution", "nearest-node"}) {
    expect_parts(refused_flags(with_cache({"--encoding", "hashgrid", "--aov", layer})),
                 {"aov", layer, "hashgrid", "`encoding` gate"});
  }
}

TEST(RefusedFlags, CheckpointFlagsNeedAFile) {
  expect_parts(refused_flags({"--resume"}), {"resume", "", "", "`checkpoint`"});
  expect_parts(refused_flags({"--checkpoint-every", "5"}), {"checkpoint-every", "", "", "`checkpoint`"});
  const renderer::CheckpointOptions options =
      read_flags({"--resume", "--checkpoint-every", "5", "--checkpoint", "c.gatelight"}).render.checkpoint;
  EXPECT_EQ(options.file, "c.gatelight");
  EXPECT_EQ(options.every_seconds, 5.0);
  EXPECT_TRUE(options.resume);
  EXPECT_EQ(read_flags({"--checkpoint", "c"}).render.checkpoint.every_seconds, 60.0);
}

TEST(RefusedFlags, NoFlagWritesAFileThatAnotherReadsOrWrites) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "d");
  std::filesystem::create_directory_symlink("d", folder / "dl");
  std::filesystem::create_symlink("d/b.exr", folder / "link.exr");
  const std::string inside = (folder / "d/b.exr").string();
  const std::vector<std::pair<Words, ErrorParts>> cases = {
      {{"--checkpoint", "a.exr"}, {"checkpoint", "a.exr", "`output`"}},
      {{"--stats", "./a.exr"}, {"stats", "./a.exr", "`output`"}},
      {{"-o", "a.exr"}, {"output", "a.exr", "twice"}},
      {{"-o", inside, "--checkpoint", (folder / "dl/b.exr").string()},
       {"checkpoint", (folder / "dl/b.exr").string(), "`output`"}},
      {{"-o", inside, "-o", (folder / "link.exr").string()},
       {"output", (folder / "link.exr").string(), "twice"}},
      {{"--stats", "room.glb"}, {"stats", "room.glb", "`SCENE`"}},
      {{"--checkpoint", "room.glb"}, {"checkpoint", "room.glb", "`SCENE`"}},
      {{"--environment", "sky.exr", "-o", "sky.exr"}, {"output", "sky.exr", "`environment`"}},
      {with_cache({"--cache-in", "c", "--stats", "c"}), {"stats", "c", "`cache-in`"}},
      {with_cache({"--cache-out", "room.glb"}), {"cache-out", "room.glb", "`SCENE`"}},
      {with_cache({"--cache-in", "room.glb", "--cache-out", "room.glb"}),
       {"cache-out", "room.glb", "`SCENE`"}},
  };
  for (const auto& [words, parts] : cases) expect_parts(refused_flags(words), parts);
  EXPECT_EQ(refused_flags(with_cache({"--cache-in", "c", "--cache-out", "c"})).option, "")
      << "trained further";
  EXPECT_EQ(refused_flags({"--stats", "-"}).option, "");
}

}  // namespace
}  // namespace gatelight::apps
