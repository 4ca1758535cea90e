// Which cells a sweep of named runs has, without a scene.

#include "apps/sweep/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/sweep/identity.h"
#include "apps/sweep/planned.h"
#include "apps/sweep/request.h"
#include "tests/apps/sweep/sweep_records.h"

namespace gatelight::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

SweepPlan plan_of_runs(std::vector<std::string> runs, FlagValues base = {}) {
  SweepArguments words = arguments(std::move(base));
  words.runs = std::move(runs);
  words.spp = "2,4";
  return plan_from(words);
}

TEST(SweepPlanOfRuns, ANamedRunIsWhatRenderMakesOfItsFlags) {
  const SweepPlan plan = plan_of_runs({"fine: --preset standard --max-depth=5", "deep: --preset standard"},
                                      {{"--size", "64x36"}, {"--max-depth", "9"}});
  // Flags of its own win over those for all cells. Paths follow where the reference depends on a flag.
  ASSERT_THAT(labels(plan),
              ElementsAre("path", "path denoised", "fine", "path #2", "path denoised #2", "deep"));
  const std::vector<PlannedSeries>& all = plan.scenes[0].series;
  for (const std::size_t i : {2u, 5u}) {
    EXPECT_TRUE(all[i].named);
    EXPECT_TRUE(all[i].settings.render.choose_integrator) << "as --preset standard has it";
    EXPECT_FALSE(all[i].settings.render.cache.train_steps.has_value());
    EXPECT_EQ(all[i].settings.render.max_depth, i == 2 ? 5 : 9);
    EXPECT_EQ(all[i - 2].settings.render.max_depth, i == 2 ? 5 : 9);
    EXPECT_THAT(all[i - 1].points, ElementsAre(2, 4));
    EXPECT_EQ(run_name(all[i], 0), all[i].label);
  }
  EXPECT_EQ(run_name(all[1], 4), "path denoised, 4 spp");
  EXPECT_EQ(plan.cell_count(), 2u * 5u);
  const std::string command = cell_command(all[5], "room.glb", 3, 0);
  EXPECT_THAT(command, HasSubstr("--preset standard"));
  EXPECT_THAT(command, HasSubstr("--seed 3 -o out.exr"));
  EXPECT_THAT(command, Not(HasSubstr("--spp")));
}

TEST(SweepPlanOfRuns, PathsBesideNamedRunsHaveOnlyTheFlagsForAllCells) {
  const SweepPlan plan = plan_of_runs({"two: --integrator path --spp 2 --sampler independent",
                                       "clamped: --preset preview --clamp 3 --prefilter accurate",
                                       "occluded: --integrator nao --train-steps 8"},
                                      {{"--threads", "1"}});
  ASSERT_THAT(labels(plan), ElementsAre("path", "two", "path denoised", "clamped", "ao", "occluded"));
  const std::vector<PlannedSeries>& all = plan.scenes[0].series;
  EXPECT_EQ(all[1].settings.render.spp, 2);
  for (const PlannedSeries& series : all) {
    EXPECT_EQ(series.settings.render.threads, 1) << series.label;
    if (series.named) continue;
    EXPECT_EQ(series.settings.render.sampler, renderer::RenderOptions().sampler) << series.label;
    EXPECT_EQ(series.settings.render.clamp, 0.0f) << series.label;
  }
  EXPECT_EQ(all[5].settings.render.cache.train_steps, 8);
}

TEST(SweepPlanOfRuns, RunsThatDifferInTheChoiceOfTheIntegratorAreNotMerged) {
  EXPECT_THAT(labels(plan_of_runs(
                  {"auto: --preset final", "nrc: --preset final --integrator nrc", "same: --preset final"})),
              ElementsAre("path", "path denoised", "auto", "nrc"));
}

TEST(SweepPlanOfRuns, NamedRunsMayBeCombinedWithAxesAndStandBesideAPreset) {
  SweepArguments words = arguments();
  words.no_plain = true;
  words.runs = {"bare: --preset bare", "wide: --preset bare --hidden 64"};
  words.vary = {"hidden=16,32"};
  EXPECT_THAT(labels(plan_from(words)), ElementsAre("bare hidden 16", "bare hidden 32", "wide hidden 64"));
  words.vary.clear();
  words.preset = "finished";
  EXPECT_THAT(labels(plan_from(words)), ElementsAre("preview", "standard", "final", "bare", "wide"));
}

TEST(SweepPresets, FinishedPicturesAreNamedRunsBesidePathsOfBothKinds) {
  SweepArguments words = arguments();
  words.preset = "finished";
  const SweepPlan plan = plan_from(words);
  EXPECT_THAT(labels(plan), ElementsAre("path", "path denoised", "preview", "standard", "final"));
  EXPECT_THAT(plan.scenes[0].series[1].points, ElementsAre(4, 8, 32, 128));
  EXPECT_EQ(plan.seeds.size(), 2u);
}

}  // namespace
}  // namespace gatelight::apps
