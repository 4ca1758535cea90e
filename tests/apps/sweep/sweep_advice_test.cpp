// The advice that is read from results.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/sweep/advise.h"
#include "apps/sweep/results.h"
#include "apps/terminal/errors.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ordered_json cell(const std::string& series, int steps, double flip, double seconds, int seed = 1,
                  const std::string& scene = "room") {
  return {{"scene", scene},
          {"series", series},
          {"run", series + ", " + std::to_string(steps) + " steps"},
          {"axes", ordered_json::object()},
          {"options", ordered_json::object()},
          {"reference", "path"},
          {"reference_id", "of " + scene},
          {"train_steps", steps},
          {"spp", 4},
          {"seed", seed},
          {"status", "done"},
          {"seconds", {{"total", seconds}}},
          {"errors", {{"flip", flip}}},
          {"command", "gatelight render " + series + std::to_string(steps) + std::to_string(seed)}};
}

ordered_json trade() {
  ordered_json failed = cell("gate", 4, 0.0, 0.0);
  failed["status"] = "failed";
  ordered_json infinite = cell("gate", 2, 0.0, 0.0);
  infinite["errors"]["flip"] = nullptr;
  return {{"cells",
           {failed, infinite, cell("gate", 8, 0.4, 1.0), cell("gate", 8, 0.2, 3.0, 2),
            cell("gate", 64, 0.1, 4.0), cell("hash", 8, 0.25, 2.5), cell("hash", 64, 0.12, 9.0)}}};
}

TEST(SweepAdvice, NamesTheCheapestThatIsGoodEnough) {
  const ordered_json results = trade();
  std::vector<MeasuredRun> runs = measured_runs(results["cells"]);
  std::erase_if(runs, [](const MeasuredRun& run) { return !run.mean("errors", "flip"); });
  const auto advise = [&](AdviceLimits limits) {
    const Advice advice = choose(runs, limits);
    return fmt::format("{} {}{}", advice.best->cell()["series"].get<std::string>(),
                       advice.best->cell()["train_steps"].get<int>(), advice.met ? "" : " (not met)");
  };
  EXPECT_EQ(advise({.max_error = 0.41, .max_seconds = {}}), "gate 8");
  EXPECT_EQ(advise({.max_error = 0.31, .max_seconds = {}}), "hash 8") << "one seed of gate has 0.4";
  EXPECT_EQ(advise({.max_error = 0.26, .max_seconds = {}}), "hash 8");
  EXPECT_EQ(advise({.max_error = 0.15, .max_seconds = {}}), "gate 64");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 2.5}), "hash 8");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 100.0}), "gate 64");
  EXPECT_EQ(advise({.max_error = 0.41, .max_seconds = 2.0}), "gate 8");
  EXPECT_EQ(advise({.max_error = 0.01, .max_seconds = {}}), "gate 64 (not met)");
  EXPECT_EQ(advise({.max_error = 0.01, .max_seconds = 3.0}), "hash 8 (not met)");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 0.5}), "gate 8 (not met)");
}

TEST(SweepAdvice, IsTextWithACommandForEachSceneAndKind) {
  ordered_json results = trade();
  results["cells"].push_back(cell("gate", 8, 0.5, 1.0, 1, "hall"));
  ordered_json bare = cell("bare", 8, 0.05, 1.0);
  bare["reference"] = "cache";
  bare["reference_id"] = "held";
  results["cells"].push_back(bare);
  const std::string text = give_advice(results, {.max_error = 0.26, .max_seconds = {}}).text;
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("room (path): hash, 8 steps, 4 spp: FLIP 0.2500, 2.5 s\n  gatelight render hash81"),
            HasSubstr("hall (path): none of 1 is within the limits; the closest is gate, 8 steps"),
            HasSubstr("room (cache): bare")));
  EXPECT_THAT(give_advice(results, {.max_error = 0.41, .max_seconds = {}}).text,
              AllOf(HasSubstr("FLIP of at most 0.41 with every seed"),
                    HasSubstr("FLIP 0.3000 (0.2000 to 0.4000 over 2 seeds), 2 s")));
  EXPECT_THAT(give_advice({{"cells", ordered_json::array()}}, {.max_error = 0.31, .max_seconds = {}}).unmet,
              HasSubstr("no cell"));
}

TEST(SweepAdvice, NamesScenesWhereNoCellMeetsTheLimits) {
  ordered_json results = trade();
  results["cells"].push_back(cell("gate", 8, 0.5, 1.0, 1, "hall"));
  const std::string unmet = give_advice(results, {.max_error = 0.26, .max_seconds = 9.5}).unmet;
  tests::expect_message(unmet, {"hall (path)", "0.26", "9.5"});
  EXPECT_THAT(unmet, Not(HasSubstr("room")));
  EXPECT_EQ(give_advice(results, {.max_error = 0.5, .max_seconds = {}}).unmet, "");
}

TEST(SweepAdvice, ErrorsAgainstDifferentReferencesAreNotCompared) {
  // Paths of two bounces are quicker, and near to a reference of two bounces.
  ordered_json results = {{"cells", ordered_json::array()}};
  for (const char* depth : {"2", "8"}) {
    for (const char* series : {"gate", "path"}) {
      ordered_json one =
          cell(fmt::format("{} max-depth {}", series, depth), 8, 0.04, depth[0] == '2' ? 1.0 : 3.0);
      one["reference_id"] = depth;
      results["cells"].push_back(one);
    }
  }
  EXPECT_THAT(give_advice(results, {.max_error = 0.05, .max_seconds = {}}).text,
              AllOf(HasSubstr("room (path, reference 2): gate max-depth 2"),
                    HasSubstr("room (path, reference 8): gate max-depth 8")));
  // Nor are they pooled as seeds of one configuration.
  for (ordered_json& one : results["cells"]) one["series"] = one["run"] = "the same";
  EXPECT_THAT(give_advice(results, {.max_error = 0.05, .max_seconds = {}}).text,
              AllOf(HasSubstr("(path, reference 2): the same, 8 steps, 4 spp: FLIP 0.0400 (0.0400 to 0.0400 "
                              "over 2 seeds), 1 s"),
                    HasSubstr("(path, reference 8): the same, 8 steps, 4 spp: FLIP 0.0400 (0.0400 to 0.0400 "
                              "over 2 seeds), 3 s")));
}

}  // namespace
}  // namespace gatelight::apps
