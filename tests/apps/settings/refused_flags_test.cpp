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

struct Refused {
  const char* flags;
  ErrorParts parts;  ///< without an option: the flags are good
};

const Refused kRefused[] = {
    // Without a cache.
    {"--batch 100", {"batch", "", "'path'", "`integrator` nao or nrc"}},
    {"--integrator ao --cache-in c", {"cache-in", "", "'ao'", "`integrator`"}},
    // Of another encoding or rule.
    {"--integrator nrc --hash-levels 4", {"hash-levels", "", "", "`encoding` hashgrid"}},
    {"--integrator nrc --encoding hashgrid --stack 1", {"stack", "", "", "`encoding` gate"}},
    {"--integrator nrc --resolution-scale 2", {"resolution-scale", "", "", "`resolution` paper"}},
    {"--integrator nrc --resolution paper --node-spacing 2",
     {"node-spacing", "", "", "`resolution` uniform"}},
    {"--integrator nrc --encoding hashgrid --candidates 4", {"candidates", "", "", "`encoding` gate"}},
    {"--integrator nrc --encoding hashgrid --candidates 1", {}},
    {"--integrator nao --encoding hashgrid --albedo-input on", {}},
    // Beside others.
    {"--animation walk", {"animation", "", "", "`time`"}},
    {"--animation walk --time 0", {}},
    {"--integrator nrc --spread-threshold 0.5", {"spread-threshold", "", "", "`query-at` spread"}},
    {"--integrator nrc --self-training off --self-training-vertices 1",
     {"self-training-vertices", "", "", "`self-training` STEP"}},
    {"--integrator nrc --self-training off --self-training-full 1",
     {"self-training-full", "", "", "`self-training` STEP"}},
    {"--integrator nrc --self-training off --self-training-attenuation 1",
     {"self-training-attenuation", "", "", "`self-training` STEP"}},
    {"--integrator nrc --self-training 0 --self-training-vertices 1 --self-training-full 1 "
     "--self-training-attenuation 1",
     {}},
    {"--integrator nrc --view cache --query-at gather", {"query-at", "", "", "`view` final"}},
    {"--integrator nrc --view cache --query-at spread", {"query-at", "", "", "`view` final"}},
    {"--resume", {"resume", "", "", "`checkpoint`"}},
    {"--checkpoint-every 5", {"checkpoint-every", "", "", "`checkpoint`"}},
    // Layers that would be black.
    {"--aov albedo,training-count", {"aov", "training-count", "'path'", "`integrator`"}},
    {"--integrator nao --aov cache-error", {"aov", "cache-error", "'nao'", "`integrator` nrc"}},
    {"--integrator nrc --encoding hashgrid --aov training-count",
     {"aov", "training-count", "hashgrid", "`encoding` gate"}},
    {"--integrator nrc --encoding hashgrid --aov resolution",
     {"aov", "resolution", "hashgrid", "`encoding` gate"}},
    {"--integrator nrc --encoding hashgrid --aov nearest-node",
     {"aov", "nearest-node", "hashgrid", "`encoding` gate"}},
    // Frames.
    {"--fps 25", {"fps", "", "no frames", "`frames`"}},
    {"--frames 0:3 --time 1", {"time", "", "excludes `frames`"}},
    {"--frames 0:3", {"output", "a.exr", "all frames", "%04d"}},
    {"--frames 4 --camera all", {"output", "a.exr", "all cameras", "{camera}"}},
    {"--frames 4", {}},
    {"--frame-groups 2", {"frame-groups", "", "no frames", "`frames`"}},
    {"--frames 4 --frame-groups 2", {"frame-groups", "", "fewer", "1"}},
    {"--turntable 4 --frame-groups 3 --integrator nrc", {"frame-groups", "", "'nrc'", "`integrator`"}},
    {"--turntable 4 --frame-groups 3 --denoiser auto", {"frame-groups", "", "denoised", "`temporal` off"}},
    {"--turntable 4 --frame-groups 3 --checkpoint state",
     {"frame-groups", "", "checkpoint", "no `checkpoint`"}},
    {"--turntable 4 --frame-groups 3 --denoiser auto --temporal off", {"output", "a.exr"}},
};

TEST(RefusedFlags, NameTheFlagAndWhatItNeeds) {
  for (const Refused& row : kRefused) {
    SCOPED_TRACE(row.flags);
    const ErrorParts parts = refused_flags(words_of(row.flags));
    EXPECT_EQ(parts.option, row.parts.option);
    if (!row.parts.option.empty()) expect_parts(parts, row.parts);
  }
}

TEST(RefusedFlags, CacheFlagsAreMarked) {
  EXPECT_GT(cache_names().size(), 40u);
  for (const char* name : {"cache-in", "cache-out", "train-steps", "device", "cache-memory"}) {
    EXPECT_TRUE(cache_names().contains(name)) << name;
  }
  for (const char* name : {"spp", "integrator", "isa", "checkpoint"}) {
    EXPECT_FALSE(cache_names().contains(name)) << name;
  }
}

TEST(RefusedFlags, ThoseOfAPresetAreAdapted) {
  const RenderSettings preset = read_flags({"--preset", "paper-nrc", "--encoding", "hashgrid"});
  EXPECT_EQ(preset.render.cache.training.feature_step, neural::FeatureStep::per_node);
  EXPECT_EQ(preset.render.cache.candidates, 1);
  EXPECT_EQ(read_flags({"--preset", "paper-nrc"}).render.cache.candidates, 16);
}

TEST(RefusedFlags, ThoseOfRadianceAreNeitherWithOcclusionNorInItsRecipe) {
  const auto recipe = resolved_options(read_flags({"--integrator", "nao"}));
  for (const char* flag : {"--cache-holds all", "--query-at primary", "--view final", "--self-training 9",
                           "--self-training-vertices 5", "--self-training-full 0.5", "--train-path-length 4",
                           "--self-training-attenuation 0.5", "--cache-roughness 0.25",
                           "--spread-threshold 0.5", "--albedo-input on", "--direction-input on"}) {
    const std::string name = words_of(flag).front().substr(2);
    expect_parts(refused_flags(words_of("--integrator nao", {}, words_of(flag))),
                 {name, "", "", "`integrator` nrc"});
    EXPECT_FALSE(recipe.contains(name)) << name;
  }
}

TEST(RefusedFlags, OthersAreCompleted) {
  EXPECT_EQ(read_flags({"--time", "-2.5"}).load.time, -2.5);
  EXPECT_FALSE(read_flags({}).load.time);
  EXPECT_EQ(read_flags({"--turntable", "1"}).load.time, 0.0);
  EXPECT_EQ(read_flags({"--frames", "12:12", "--fps", "24"}).load.time, 0.0) << "the film's first frame";
  // The settings say where the bare answer is queried.
  EXPECT_EQ(read_cache({"--view", "cache"}).query_at, renderer::QueryAt::primary);
  EXPECT_EQ(read_cache({"--view", "cache", "--query-at", "none"}).query_at, renderer::QueryAt::none);
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
