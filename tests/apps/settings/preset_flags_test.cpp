// Presets beside flags, and recipes, which can be passed back as flags.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/reports/recipe.h"
#include "tests/apps/settings/read_flags.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::Integrator;
using ::testing::ElementsAre;
using tests::TemporaryFolder;

TEST(PresetFlags, EveryFlagOverridesThemInAnyOrder) {
  const Words flags = words_of("--spp 3 --size 64x32 --query-at gather --candidates 2 --aov all");
  // The paper's view is the bare answer, where gathering has no effect.
  const Words before = words_of("--preset paper-nrc --view final", {}, flags);
  Words after = flags;
  after.insert(after.end(), {"--view", "final", "--preset", "paper-nrc"});
  const RenderSettings first = read_flags(before);
  EXPECT_EQ(first.render.integrator, Integrator::nrc);
  EXPECT_EQ(first.render.spp, 3);
  EXPECT_EQ(first.render.width, 64);
  EXPECT_EQ(first.render.cache.query_at, renderer::QueryAt::gather);
  EXPECT_EQ(first.render.cache.candidates, 2);
  EXPECT_EQ(first.render.cache.batch, 49152u) << "the preset's";
  EXPECT_EQ(first.render.cache.component, renderer::CachedComponent::all) << "the preset's";
  EXPECT_EQ(first.outputs, Words{"a.exr"});
  EXPECT_EQ(resolved_options(first), resolved_options(read_flags(after)));
}

TEST(PresetFlags, EveryFlagOfAConfigFileOverridesThem) {
  TemporaryFolder folder;
  const std::string flags = "spp = 3\ncandidates = 2\nstack = [\"adaptive\", 4]\nreproducible = true\n";
  const std::string without = folder.write("w.toml", flags);
  const std::string first = folder.write("f.toml", "preset = \"paper-nao\"\n" + flags);
  const std::string last = folder.write("l.toml", flags + "preset = \"paper-nao\"\n");
  const RenderSettings settings = read_flags({"--preset", "paper-nao", "--config", without});
  EXPECT_EQ(settings.render.integrator, Integrator::nao);
  EXPECT_EQ(settings.render.width, 1920);
  EXPECT_EQ(settings.render.spp, 3);
  EXPECT_EQ(settings.render.cache.candidates, 2);
  EXPECT_EQ(settings.render.cache.gate.features, 2u) << "the preset's";
  EXPECT_THAT(settings.render.cache.gate.stack, ElementsAre(0, 4));
  EXPECT_TRUE(settings.reproducible);
  const ordered_json options = resolved_options(settings);
  EXPECT_EQ(resolved_options(read_flags({"--config", first})), options);
  EXPECT_EQ(resolved_options(read_flags({"--config", last})), options);
  // The command line's preset replaces the file's, and the command line's flags win.
  const RenderSettings both = read_flags({"--spp", "9", "--preset", "preview", "--config", last});
  EXPECT_EQ(both.render.integrator, Integrator::nrc);
  EXPECT_EQ(both.render.spp, 9);
  EXPECT_EQ(both.render.cache.candidates, 2);
}

TEST(PresetFlags, ChooseTheIntegratorUnlessItIsGiven) {
  EXPECT_EQ(read_flags({"--preset", "final"}).render.integrator, Integrator::nrc);
  EXPECT_EQ(read_flags({"--preset", "paper-nrc", "--integrator", "nao"}).render.integrator, Integrator::nao);
  EXPECT_TRUE(read_flags({"--preset", "final"}).render.choose_integrator);
  EXPECT_FALSE(read_flags({"--preset", "final", "--integrator", "nrc"}).render.choose_integrator);
  EXPECT_FALSE(read_flags({"--preset", "final", "--train-steps", "9"}).render.choose_integrator)
      << "a flag of the cache implies one";
  // Paths get more samples in the same time, unless their number is given.
  for (const char* const flag : {"--integrator=path", "--light-groups=a=*"}) {
    const RenderSettings paths = read_flags({"--preset", "standard", flag});
    EXPECT_EQ(paths.render.integrator, Integrator::path);
    EXPECT_FALSE(paths.render.choose_integrator);
    EXPECT_EQ(paths.render.spp, 12);
    EXPECT_EQ(paths.render.denoise.denoiser, renderer::DenoiserKind::automatic);
  }
  EXPECT_EQ(read_flags({"--preset", "standard", "--integrator", "path", "--spp", "5"}).render.spp, 5);
  const RenderSettings chosen = read_flags({"--integrator", "auto"});
  EXPECT_TRUE(chosen.render.choose_integrator);
  EXPECT_EQ(chosen.render.integrator, Integrator::nrc);
}

TEST(PresetFlags, ChooseTheDeviceUnlessItIsGiven) {
  for (const char* const preset : {"bare", "final", "paper-nao"}) {
    EXPECT_TRUE(read_flags({"--preset", preset}).render.cache.choose_device);
    EXPECT_FALSE(read_flags({"--preset", preset, "--device", "cpu"}).render.cache.choose_device);
  }
  EXPECT_FALSE(read_flags({"--integrator", "nrc"}).render.cache.choose_device);
  const RenderSettings chosen = read_flags({"--integrator", "nrc", "--device", "auto"});
  EXPECT_TRUE(chosen.render.cache.choose_device);
  EXPECT_EQ(chosen.render.cache.device, "cpu");
}

TEST(Recipe, CanBePassedBackAsFlags) {
  for (const char* flags :
       {"--size 64x32 --region 1,2,3,4 --spp 3 --seed 4294967295 --aov all --eye 1,-2.5,3 --target 0,0.1,0 "
        "--environment 0.1,2,3 --fov 30.1 --ao-distance inf --exposure -1.5 --exr float --scene-index -1 "
        "--missing warn",
        "--camera front --environment sky.exr --time-limit 0.5 --checkpoint c", "--integrator nrc",
        "--preset paper-nao", "--preset paper-nrc --encoding hashgrid --cache-memory 0.1",
        "--preset paper-nao --encoding hashgrid", "--integrator nrc --view cache",
        "--integrator nrc --query-at spread",
        "--preset preview --node-spacing 0.1 --self-training off --train-steps 12",
        "--integrator nao --resolution fixed:3 --stack adaptive,adaptive/3,2 --average off "
        "--query-precision bf16 --learning-rate 0.003 --cache-in i"}) {
    RenderSettings settings = read_flags(words_of(flags));
    settings.preset.reset();
    const ordered_json options = resolved_options(settings);
    Words again;
    for (const Option& option : option_table(settings)) {
      if (options.contains(option.name) && option.read && !option.text().empty())
        again.push_back(option.flag() + "=" + option.text());
    }
    EXPECT_GT(again.size(), 25u);
    EXPECT_EQ(resolved_options(read_flags(again)), options);
  }
}

TEST(CacheRecipe, ExistsOnlyWithACache) {
  const ordered_json path = resolved_options(read_flags({}));
  const ordered_json cache =
      resolved_options(read_flags({"--integrator", "nrc", "--cache-out", "o", "--cache-roughness", "0.3"}));
  EXPECT_FALSE(path.contains("batch"));
  EXPECT_FALSE(path.contains("train-steps"));
  EXPECT_EQ(cache["train-steps"], "auto");
  EXPECT_EQ(cache["cache-roughness"], ordered_json(0.3)) << "the digits of a float";
  EXPECT_EQ(cache["cache-out"], "o");
  const ordered_json reproducible = resolved_options(
      read_flags({"--preset", "final", "--cache-out", "o", "--checkpoint", "c", "--reproducible"}));
  for (const char* key : {"preset", "cache-out", "checkpoint"})
    EXPECT_FALSE(reproducible.contains(key)) << key;
}

}  // namespace
}  // namespace gatelight::apps
