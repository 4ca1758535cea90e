// Times of equal error, and results.md, from figures that are made up here.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/sweep/measured_runs.h"
#include "apps/sweep/results_table.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Points = std::vector<std::pair<double, double>>;

// Error 8 / seconds, as path tracing has it.
const Points kPoints = {{4.0, 2.0}, {1.0, 8.0}, {16.0, 0.5}};

TEST(SweepEqualError, PowerLawsAreMetBetweenPointsAndBeyond) {
  const std::pair<double, bool> cases[] = {
      {8.0, false}, {3.0, false}, {0.5, false}, {0.1, true}, {20.0, true}};
  for (const auto& [error, beyond] : cases) {
    const std::optional<EqualSeconds> equal = equal_error_seconds(kPoints, error);
    ASSERT_TRUE(equal.has_value()) << error;
    EXPECT_NEAR(equal->seconds, 8.0 / error, 1e-9);
    EXPECT_EQ(equal->extrapolated, beyond) << error;
  }
}

TEST(SweepEqualError, EachPieceHasASlopeOfItsOwn) {
  const Points points = {{1.0, 8.0}, {4.0, 4.0}, {100.0, 1.0}};
  EXPECT_NEAR(equal_error_seconds(points, 2.0)->seconds, 20.0, 1e-9);
  EXPECT_NEAR(equal_error_seconds(points, 4.0 * std::sqrt(2.0))->seconds, 2.0, 1e-9);
}

TEST(SweepEqualError, PointsWithoutAnAnswerGiveNone) {
  EXPECT_FALSE(equal_error_seconds({}, 1.0).has_value());
  EXPECT_FALSE(equal_error_seconds({{1.0, 1.0}}, 1.0).has_value());
  EXPECT_FALSE(equal_error_seconds(kPoints, -0.1).has_value());
  EXPECT_FALSE(equal_error_seconds(kPoints, std::nan("")).has_value());
  EXPECT_FALSE(equal_error_seconds({{1.0, 1.0}, {2.0, 1.0}}, 0.5).has_value()) << "it does not fall";
  EXPECT_FALSE(equal_error_seconds({{1.0, -1.0}, {2.0, 1.0}}, 1.0).has_value()) << "one error is negative";
}

ordered_json measured(const std::string& series, int spp, double seconds, double error, int seed = 1) {
  const bool denoised = series == "path denoised";
  return {{"status", "done"},
          {"scene", "bath"},
          {"series", series},
          {"run", series + ", " + std::to_string(spp) + " spp"},
          {"train_steps", nullptr},
          {"axes", ordered_json::object()},
          {"options", {{"size", {32, 18}}, {"denoiser", denoised ? "oidn" : "none"}}},
          {"reference", "path"},
          {"reference_id", "r"},
          {"seed", seed},
          {"seconds", {{"total", seconds}}},
          {"errors", {{"rel_mse_clean", error}, {"bias_rel_mse", nullptr}, {"flip", nullptr}}}};
}

ordered_json named(const std::string& name, double seconds, double error, int seed = 1) {
  ordered_json run = measured(name, 4, seconds, error, seed);
  run["run"] = name;
  run["axes"]["row"] = name;
  run["options"]["denoiser"] = "oidn";
  return run;
}

/// Paths as traced, and denoised with half the error, beside a run of two seeds.
ordered_json results() {
  ordered_json cells = ordered_json::array();
  for (const char* series : {"path", "path denoised"}) {
    for (std::size_t i = 0; i < kPoints.size(); ++i) {
      const auto [seconds, error] = kPoints[i];
      const double share = series == std::string("path") ? 1.0 : 0.5;
      cells.push_back(measured(series, 1 << i, seconds, share * error));
    }
  }
  cells.push_back(named("cached", 1.0, 0.5, 1));
  cells.push_back(named("cached", 3.0, 1.5, 2));
  cells.back()["errors"]["bias_rel_mse"] = 0.25;
  add_equal_error(cells);
  return {{"scenes", {{{"name", "bath"}, {"references", {{{"kind", "path"}, {"rel_mse_noise", 0.00125}}}}}}},
          {"cells", cells}};
}

const ordered_json& cell_of(const ordered_json& results, const std::string& run) {
  for (const ordered_json& cell : results.at("cells")) {
    if (cell.at("run") == run) return cell;
  }
  throw std::runtime_error(run);
}

TEST(SweepEqualError, IsOfMeansAgainstPathTracingOfTheSamePicture) {
  ordered_json all = results();
  // The mean is an error of 1 after 2 seconds, for which paths need 8 and 4.
  const ordered_json cached = cell_of(all, "cached");
  EXPECT_NEAR(cached["equal_seconds"]["rel_mse_clean"], 8.0, 1e-9);
  EXPECT_NEAR(cached["times_faster"]["rel_mse_clean"], 4.0, 1e-9);
  EXPECT_NEAR(cached["times_faster"]["denoised_rel_mse_clean"], 2.0, 1e-9);
  EXPECT_EQ(cached["extrapolated"]["rel_mse_clean"], false);
  EXPECT_TRUE(cached["times_faster"]["flip"].is_null());
  EXPECT_EQ(all["cells"].back()["times_faster"], cached["times_faster"]) << "all seeds have the same";
  // A baseline is only compared with those before it.
  EXPECT_TRUE(cell_of(all, "path, 1 spp")["times_faster"]["rel_mse_clean"].is_null());
  EXPECT_NEAR(cell_of(all, "path denoised, 1 spp")["times_faster"]["rel_mse_clean"], 2.0, 1e-9);
  EXPECT_TRUE(cell_of(all, "path denoised, 1 spp")["times_faster"]["denoised_rel_mse_clean"].is_null());
  // Others are neither paths against another reference, nor a named run that takes paths.
  const ordered_json before = cached;
  for (const char* key : {"reference_id", "scene"}) {
    ordered_json other = measured("path", 1, 1000.0, 8.0);
    other[key] = "another";
    all["cells"].push_back(other);
  }
  all["cells"].push_back(named("paths", 1000.0, 8.0));
  add_equal_error(all["cells"]);
  EXPECT_EQ(cell_of(all, "cached"), before);
}

TEST(SweepTable, HasARowForEachSceneAndOneForEachRun) {
  const std::string text = results_table(results());
  EXPECT_THAT(
      text,
      AllOf(StartsWith("| | path denoised, 1 spp | path denoised, 2 spp | path denoised, 4 spp | cached |\n"
                       "|---|---|---|---|---|\n"
                       "| bath, 32x18 | 4.0 s, 1.0000, - | 1.0 s, 4.0000, - | 16.0 s, .2500, - | 2.0 s, "
                       "1.0000, - (2; -) |\n\nSeconds: "),
            HasSubstr("| bath, 32x18 | path, 1 spp | 4.0 | 2.0000 |  |  |  |  |\n"
                      "|  | path, 2 spp | 1.0 | 8.0000 |"),
            HasSubstr("|  | cached | 2.0 | 1.0000 | 0.2500 |  | 4; - | 2; - |\n"),
            HasSubstr("\nNoise of the references in rel. MSE: bath, path: 0.0013.\n")));
}

TEST(SweepTable, MarksWhatIsExtrapolatedAndTheDeviationOfThreeSeeds) {
  ordered_json all = results();
  all["cells"].push_back(named("cached", 2.0, 0.0001, 3));
  all["cells"].push_back(named("small", 1.0, 0.125));
  add_equal_error(all["cells"]);
  EXPECT_THAT(results_table(all), AllOf(HasSubstr("|  | cached | 2.0 ± 1.0 | 0.6667 ± 0.7637 | 0.2500 |"),
                                        HasSubstr("|  | small | 1.0 | 0.1250 |  |  | 64*; - | 32*; - |")));
}

TEST(SweepTable, WithoutNamedRunsHasNoRowsOfScenes) {
  ordered_json all = results();
  while (all["cells"].back()["run"] == "cached") all["cells"].erase(all["cells"].size() - 1);
  EXPECT_THAT(results_table(all), StartsWith("Seconds: "));
  all["cells"].back()["status"] = "failed";
  EXPECT_THAT(results_table(all), Not(HasSubstr("path denoised, 4 spp")));
}

}  // namespace
}  // namespace gatelight::apps
