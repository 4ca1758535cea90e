// Which cells a sweep has, without a scene.

#include "apps/settings/complete_settings.h"
#include "apps/sweep/plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "apps/reports/recipe.h"
#include "apps/settings/flags.h"
#include "apps/sweep/planned.h"
#include "apps/sweep/presets.h"
#include "apps/sweep/request.h"
#include "apps/terminal/errors.h"
#include "tests/apps/sweep/sweep_records.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

SweepPlan plan_of(FlagValues base, std::vector<std::string> vary = {}, bool no_plain = true,
                  const std::string& preset = "") {
  SweepArguments words = arguments(std::move(base), std::move(vary), "8,16");
  words.no_plain = no_plain;
  words.preset = preset;
  return plan_from(words);
}

TEST(SweepPlan, CombinesAllValuesOfAllAxes) {
  const SweepPlan plan = plan_of({}, {"features=2,4", "hidden=16,32"});
  EXPECT_THAT(labels(plan), ElementsAre("nrc gate features 2 hidden 16", "nrc gate features 2 hidden 32",
                                        "nrc gate features 4 hidden 16", "nrc gate features 4 hidden 32"));
  EXPECT_THAT(plan.scenes[0].series[1].axes, ElementsAre(Pair("features", "2"), Pair("hidden", "32")));
  EXPECT_EQ(plan.scenes[0].series[1].settings.render.cache.gate.features, 2u);
  EXPECT_EQ(plan.scenes[0].series[1].settings.render.cache.mlp.width, 32u);
  EXPECT_EQ(plan.run_count(), 4u);
  EXPECT_EQ(plan.cell_count(), 8u);
}

TEST(SweepPlan, TooManyCellsAreRefusedBeforeTheyAreCombined) {
  std::string batches = "batch=256", rates = "learning-rate=0.001";
  for (int i = 1; i < 2000; ++i) {
    batches += fmt::format(",{}", 256 + i);
    rates += fmt::format(",{:.3f}", 0.001 * (i + 1));
  }
  tests::expect_refused_parts<BadOption>(
      [&] {
        plan_of({}, {batches, rates});
      },
      {"vary", "", "4000000", "10000"});
}

TEST(SweepPlan, FlagsWithoutEffectAreLeftOutAndEqualCellsAreMerged) {
  const SweepPlan plan = plan_of({}, {"encoding=gate,hashgrid", "features=2,4", "hash-levels=4,8"});
  EXPECT_THAT(labels(plan), ElementsAre("nrc gate features 2", "nrc gate features 4",
                                        "nrc hashgrid hash-levels 4", "nrc hashgrid hash-levels 8"));
  EXPECT_THAT(plan.scenes[0].series[2].axes,
              ElementsAre(Pair("encoding", "hashgrid"), Pair("hash-levels", "4")));
}

TEST(SweepPlan, BaseFlagsOfACacheDoNotReachPlainIntegrators) {
  const SweepPlan plan = plan_of({{"--batch", "512"}, {"--max-depth", "3"}}, {"integrator=path,nrc"});
  ASSERT_THAT(labels(plan), ElementsAre("path", "nrc gate"));
  EXPECT_THAT(plan.scenes[0].series[0].flags,
              UnorderedElementsAre(Pair("--integrator", "path"), Pair("--max-depth", "3")));
  EXPECT_EQ(plan.scenes[0].series[0].settings.render.max_depth, 3);
  EXPECT_THAT(plan.scenes[0].series[0].points, ElementsAre(1, 4, 16, 64));
  EXPECT_THAT(plan.scenes[0].series[1].points, ElementsAre(8, 16));
  EXPECT_EQ(plan.scenes[0].series[1].settings.render.cache.batch, 512u);
}

TEST(SweepPlan, EachCacheHasThePlainIntegratorBesideIt) {
  const SweepPlan plan = plan_of({}, {"integrator=nrc,nao", "features=2,4"}, false);
  EXPECT_THAT(labels(plan), UnorderedElementsAre("nrc gate features 2", "nrc gate features 4", "path",
                                                 "nao gate features 2", "nao gate features 4", "ao"));
  for (const PlannedSeries& s : plan.scenes[0].series) {
    const bool radiance = s.label.starts_with("nrc") || s.label == "path";
    EXPECT_EQ(s.reference, radiance ? ReferenceKind::path : ReferenceKind::ao) << s.label;
  }
  // A flag that changes the plain picture is measured for each value.
  EXPECT_THAT(labels(plan_of({}, {"max-depth=2,3"}, false)),
              UnorderedElementsAre("nrc gate max-depth 2", "path max-depth 2", "nrc gate max-depth 3",
                                   "path max-depth 3"));
}

TEST(SweepPlan, TheBareCacheHasAReferenceOfItsOwnAndNoPlainRow) {
  const SweepPlan plan = plan_of({}, {"view=final,cache"}, false);
  ASSERT_THAT(labels(plan), ElementsAre("nrc gate view final", "path", "nrc gate view cache"));
  EXPECT_EQ(plan.scenes[0].series[2].reference, ReferenceKind::cache);
}

TEST(SweepPlan, TheDefaultIsTheBareAndTheFinishedCacheBesidePathTracingOfBothKinds) {
  const SweepPlan plan = plan_from(arguments({{"--size", "64x36"}}));
  ASSERT_THAT(labels(plan), ElementsAre("nrc bare", "path", "nrc standard spp 2", "path denoised",
                                        "nrc standard spp 7", "nrc standard spp 28"));
  EXPECT_EQ(plan.seeds.size(), 1u);
  const std::vector<PlannedSeries>& all = plan.scenes[0].series;
  for (const PlannedSeries& s : all) {
    const bool finished = s.label.starts_with("nrc standard") || s.label == "path denoised";
    EXPECT_EQ(s.settings.render.denoise.denoiser,
              finished ? renderer::DenoiserKind::oidn : renderer::DenoiserKind::none)
        << s.label;
    EXPECT_THAT(s.axes, Contains(Pair("denoiser", finished ? "oidn" : "none"))) << s.label;
    EXPECT_EQ(s.reference, ReferenceKind::path);
    EXPECT_EQ(s.settings.render.width, 64);
  }
  EXPECT_THAT(all[0].points, ElementsAre(8, 16, 32, 64, 128, 256, 512, 1024));
  EXPECT_THAT(all[1].points, ElementsAre(1, 4, 16, 64));
  EXPECT_EQ(all[3].points, all[1].points);
  EXPECT_THAT(all[4].points, ElementsAre(128, 512, 2048));
  EXPECT_EQ(all[4].settings.render.spp, 7);
  EXPECT_EQ(cell_command(all[3], "room.glb", 1, 4),
            "gatelight render room.glb --size 64x36 --integrator path --denoiser oidn --spp 4 --seed 1 -o "
            "out.exr");
  // Given steps apply to all rows.
  const SweepPlan short_plan = plan_from(arguments({}, {}, "8,16"));
  for (const PlannedSeries& s : short_plan.scenes[0].series) {
    if (s.has_cache()) {
      EXPECT_THAT(s.points, ElementsAre(8, 16)) << s.label;
    }
  }
}

TEST(SweepPlan, FlagsThatContradictTheDefaultRowsReplaceThem) {
  const SweepPlan gather = plan_from(arguments({{"--query-at", "gather"}}));
  ASSERT_THAT(labels(gather), ElementsAre("nrc gate", "path"));
  EXPECT_THAT(gather.scenes[0].series[0].points, ElementsAre(8, 16, 32, 64, 128, 256, 512, 1024));
  EXPECT_EQ(gather.scenes[0].series[0].settings.render.spp, 4);
  EXPECT_THAT(labels(plan_from(arguments({{"--view", "cache"}}))), ElementsAre("nrc gate"));
  EXPECT_THAT(labels(plan_from(arguments({{"--denoiser", "oidn"}}))),
              ElementsAre("nrc gate denoised", "path", "path denoised"));
}

TEST(SweepPlan, DenoisedRowsHavePathTracingOfBothKindsBesideThem) {
  EXPECT_THAT(labels(plan_from(arguments({}, {"denoiser=none,oidn"}))),
              ElementsAre("nrc gate", "path", "nrc gate denoised", "path denoised"));
  EXPECT_THAT(labels(plan_of({}, {"integrator=path", "denoiser=none,oidn"})),
              ElementsAre("path", "path denoised"));
  EXPECT_THAT(labels(plan_of({}, {}, false, "standard")),
              ElementsAre("nrc gate denoised", "path", "path denoised"));
  EXPECT_THAT(labels(plan_of({}, {"preset=standard"}, true)), ElementsAre("nrc gate"));
  EXPECT_THAT(labels(plan_of({}, {"integrator=nao", "denoiser=oidn"}, false)),
              ElementsAre("nao gate denoised", "ao", "ao denoised"));
}

TEST(SweepPlan, APresetOfRenderIsAValueLikeAnyOther) {
  const SweepPlan plan = plan_of({}, {"preset=bare,paper-nao"}, false);
  ASSERT_THAT(labels(plan), ElementsAre("nrc gate preset bare", "path", "nao gate preset paper-nao", "ao"));
  EXPECT_EQ(plan.scenes[0].series[0].settings.render.spp, 4);
  EXPECT_EQ(plan.scenes[0].series[2].settings.render.cache.batch, 49152u);
  // The plain picture has the preset's size, so that it can be compared.
  EXPECT_EQ(plan.scenes[0].series[3].settings.render.width, 1920);
  EXPECT_THAT(plan.scenes[0].series[3].flags, Contains(Pair("--size", "1920x1080")));
}

TEST(SweepPlan, MemoryOfGateIsComputedWithAllFlagsThatDecideIt) {
  const SweepPlan plan =
      plan_of({}, {"encoding=gate,hashgrid", "features=2,4", "cache-memory=same-as-gate,same-as-gate/2,3"});
  // GATE is itself with same-as-gate, whatever the divisor; the limit of 3 MiB is another cache.
  EXPECT_THAT(
      labels(plan),
      ElementsAre("nrc gate features 2", "nrc gate features 2 cache-memory 3", "nrc gate features 4",
                  "nrc gate features 4 cache-memory 3", "nrc hashgrid features 2 cache-memory same-as-gate",
                  "nrc hashgrid features 2 cache-memory same-as-gate/2", "nrc hashgrid cache-memory 3",
                  "nrc hashgrid features 4 cache-memory same-as-gate",
                  "nrc hashgrid features 4 cache-memory same-as-gate/2"));
  const PlannedSeries& like = plan.scenes[0].series[8];
  ASSERT_TRUE(like.memory.has_value());
  EXPECT_EQ(like.memory->divisor, 2.0);
  EXPECT_EQ(like.memory->settings.render.cache.gate.features, 4u);
  EXPECT_EQ(like.memory->settings.render.cache.encoding, neural::FeatureEncoding::gate);
  EXPECT_FALSE(plan.scenes[0].series[0].memory.has_value());
  EXPECT_THROW(plan_of({{"--cache-memory", "same-as-gate*2"}}), BadOption);
  EXPECT_THROW(plan_of({{"--cache-memory", "same-as-gate/0"}}), BadOption);
}

TEST(SweepPlan, ABadValueInAnyCellIsRefusedAtOnce) {
  const auto refusal = [](FlagValues base, std::vector<std::string> vary) {
    return tests::refused_parts<BadOption>([&] { plan_of(std::move(base), std::move(vary)); });
  };
  tests::expect_parts(refusal({}, {"features=2,17"}), {"features", "17"});
  tests::expect_parts(refusal({}, {"encoding=gate,grid"}), {"encoding", "grid"});
  tests::expect_parts(refusal({{"--size", "0x3"}}, {}), {"size", "0x3"});
  // The flag has no effect here, but its value is still checked.
  tests::expect_parts(refusal({{"--hash-levels", "x"}}, {}), {"hash-levels", "x"});
}

TEST(SweepPlan, AllowExternalAppliesToScenesAndIsInTheCommand) {
  for (const bool allowed : {false, true}) {
    SweepArguments words = arguments();
    words.allow_external = allowed;
    const SweepPlan plan = plan_from(words);
    for (const PlannedSeries& series : plan.scenes[0].series) {
      EXPECT_EQ(series.settings.load.allow_external, allowed);
      const std::string command = cell_command(series, "room.glb", 1, 8);
      EXPECT_EQ(command.find("--allow-external") != std::string::npos, allowed) << command;
    }
  }
}

TEST(SweepPlan, TheCommandReproducesTheCell) {
  const SweepPlan plan = plan_of({{"--camera", "it's here"}, {"--exposure", "-1"}},
                                 {"stack=adaptive,1;adaptive", "preset=bare,paper-nrc"}, false);
  ASSERT_EQ(plan.scenes[0].series.size(), 5u);
  for (const PlannedSeries& series : plan.scenes[0].series) {
    const int point = series.points.back();
    const std::string command = cell_command(series, "a room.glb", 7, point);
    EXPECT_THAT(command, AllOf(HasSubstr("gatelight render 'a room.glb' "), HasSubstr("'it'\\''s here'"),
                               HasSubstr("--seed 7"), HasSubstr(" -o out.exr")));
    std::vector<std::string> words = words_of(series.flags);
    for (const std::string& word : {std::string(series.has_cache() ? "--train-steps" : "--spp"),
                                    std::to_string(point), std::string("--seed"), std::string("7")}) {
      words.push_back(word);
    }
    RenderSettings read = parse_render_arguments("a room.glb", words);
    complete_settings(read);
    EXPECT_EQ(dump_options(read), dump_options(cell_settings(series, "a room.glb", 7, point)))
        << series.label;
  }
}

TEST(SweepPlan, SeriesThatDifferInAnyFlagAreNotMerged) {
  const auto count = [](std::vector<std::string> vary) {
    return plan_of({}, std::move(vary)).scenes[0].series.size();
  };
  EXPECT_EQ(count({"features=2,4", "exposure=0,1", "threads=1,2", "camera=a,b", "environment=none;1,1,1",
                   "tonemap=none,filmic"}),
            64u);
  for (const char* vary : {"sky=none;sun=90,20;sun=90,40", "memory-limit=0,100,200", "fov=40,50,60"})
    EXPECT_EQ(count({vary}), 3u) << vary;
  EXPECT_THROW(plan_of({}, {"lights=lamp=2;lamp=3"}), BadOption) << "a scene is loaded once";
}

TEST(SweepPlan, ScenesOfOneNameGetDifferentNames) {
  SweepArguments words;
  words.scenes = {"a/room.glb", "b/room.glb", "hall.glb"};
  std::vector<std::string> names;
  for (const SweepScene& scene : make_request(words).scenes) names.push_back(scene.name);
  EXPECT_THAT(names, ElementsAre("a-room", "b-room", "hall"));
  words.scenes = {"a/room.glb", "a/./room.glb"};
  EXPECT_THROW(make_request(words), BadOption);
}

TEST(SweepPlan, ASceneMayHaveFlagsOfItsOwn) {
  SweepArguments words = arguments({{"--camera", "front"}}, {"features=2,4"});
  words.scenes = {"room.glb", "a/hall.glb"};
  words.scene_flags = {"hall:camera=gate=1", "a/hall.glb:environment=1,1,1"};
  const SweepPlan plan = plan_from(words);
  EXPECT_EQ(plan.scenes[0].series[0].settings.render.camera.name, "front");
  EXPECT_TRUE(plan.scenes[0].series[0].settings.render.environment.automatic);
  for (const PlannedSeries& series : plan.scenes[1].series) {
    EXPECT_EQ(series.settings.render.camera.name, "gate=1");
    EXPECT_FALSE(series.settings.render.environment.automatic);
    EXPECT_FALSE(series.settings.render.environment.none());
    EXPECT_THAT(series.flags, Contains(Pair("--camera", "gate=1")));
  }
  for (const char* bad : {"hall", "hall:", "hall:=1", "cellar:camera=a", "hall:features=2", "hall:seed=1",
                          "hall:output=a.exr", "hall:frob=1"}) {
    words.scene_flags = {bad};
    EXPECT_THROW(make_request(words), BadOption) << bad;
  }
}

TEST(SweepPresets, EachIsAPlanOfRowsForBothOfThePapersCaches) {
  for (const std::string_view name : sweep_preset_names()) {
    if (name.substr(0, 6) != "paper-" || sweep_preset(name).blocks.empty()) continue;
    const SweepPlan plan = plan_of({{"--size", "64x36"}}, {}, false, std::string(name));
    std::set<std::string> integrators;
    for (const PlannedSeries& s : plan.scenes[0].series) {
      EXPECT_EQ(s.settings.render.width, 64);
      integrators.insert(std::string(s.label.substr(0, 3)));
      EXPECT_THAT(s.label, Not(HasSubstr("#"))) << name;
      EXPECT_THAT(s.axes, Contains(Pair("row", Not(IsEmpty()))));
    }
    EXPECT_THAT(integrators, ElementsAre("nao", "nrc")) << name;
    EXPECT_EQ(plan.seeds.size(), 3u);
    EXPECT_GE(plan.scenes[0].series.size(), 6u) << name;
  }
  const SweepPlan table = plan_of({}, {}, false, "paper-table2");
  EXPECT_THAT(labels(table),
              ElementsAre("nao gate", "nao hash grid L", "nao hash grid M", "nao hash grid S", "nrc gate",
                          "nrc hash grid L", "nrc hash grid M", "nrc hash grid S"));
  EXPECT_EQ(table.scenes[0].series[3].settings.render.cache.memory_bytes, 954205u);
  EXPECT_EQ(table.scenes[0].series[0].settings.render.width, 1920);
}

}  // namespace
}  // namespace gatelight::apps
