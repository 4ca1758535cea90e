// The command line of sweeps: arguments, help, progress, advice.

#include "tests/apps/sweep/sweep_test.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SweepCommand : public SweepTest {};

TEST_F(SweepCommand, ADryRunOnlyPrintsThePlan) {
  const Output output =
      run_gatelight_inside(words("out", {"--dry-run", "--features", "2,4", "--seeds", "3"}));
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_THAT(output.out, AllOf(HasSubstr("cornell-box"), HasSubstr("nrc gate features 2"),
                                HasSubstr("steps 2,4"), HasSubstr("9 runs, 18 cells")));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(SweepCommand, BadArgumentsAreCode1BeforeTheWork) {
  const auto expect_refused = [&](const Words& more, const NameList& names) {
    expect_failure(run_gatelight_inside(words("out", more)), 1, names);
    EXPECT_FALSE(fs::exists(folder / "out"));
  };
  expect_refused({"--features", "2,17"}, {"--features", "17"});
  expect_refused({"--encoding", "gate", "--encodings", "gate,hashgrid"}, {"--encodings"});
  expect_refused({"--frob", "1"}, {"--frob"});
  expect_refused({"--max-error", "0.1"}, {"--advise"});
  expect_refused({"--advise"}, {"--max-error"});
  expect_refused({"--vary", "frob=1"}, {"--vary", "frob"});
  expect_refused({"--vary", "sampelr=sobol"}, {"--vary", "did you mean 'sampler'?"});
  expect_refused({"--reference", path("r.exr"), "--integrators", "nrc,nao"}, {"--reference-spp"});
  expect_refused({"--reference", "a", "--reference", "b", "--reference", "c"}, {"--reference", "'c'"});
  expect_refused({"--run", "bare"}, {"--run", "bare"});
  expect_failure(run_gatelight_inside({"sweep", "-o", path("out")}), 1, {"SCENE"});
  EXPECT_EQ(run_gatelight_inside(words("out", {}, path("none.glb"))).exit_code, 2);
  EXPECT_EQ(run_gatelight_inside(words("out", {"--camera", "none such"})).exit_code, 1);
}

TEST_F(SweepCommand, AFolderThatCannotBeWrittenIsCode3) {
  folder.write("file", "");
  EXPECT_EQ(run_gatelight_inside(words("file", {})).exit_code, 3);
  EXPECT_EQ(run_gatelight_inside(words("file/sub", {})).exit_code, 3);
}

TEST_F(SweepCommand, AdviceNeedsNeitherSceneNorTime) {
  swept("out", {});
  const Output one = run_gatelight_inside({"sweep", "-o", path("out"), "--advise", "--max-error", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.out, AllOf(HasSubstr("cornell-box (path): "), HasSubstr("\n  gatelight render "),
                             HasSubstr("-o out.exr\n")));
  const Output none = run_gatelight_inside(words("out", {"--advise", "--max-error", "0"}));
  EXPECT_THAT(none.out, HasSubstr("none of 4 is within the limits; the closest is"));
  expect_failure(none, 8, {"--advise", "cornell-box (path)", "0"});
  const Output again = run_gatelight_inside({"sweep", "-o", path("out"), "--advise", "--max-error", "0"});
  EXPECT_EQ(again.exit_code, 8);
  EXPECT_EQ(again.out, none.out);
  folder.write("empty/results.json", R"({"schema": 2, "cells": []})");
  const Output empty = run_gatelight_inside({"sweep", "-o", path("empty"), "--advise", "--max-time", "1"});
  expect_failure(empty, 8, {"--advise", "cell"});
  EXPECT_EQ(empty.out, "");
  EXPECT_EQ(run_gatelight_inside({"sweep", "-o", path("nothing"), "--advise", "--max-time", "1"}).exit_code,
            2);
  // Without a scene nothing else has an effect.
  for (const Words& more : {Words{"--features", "2"},
                            {"--seeds", "2"},
                            {"--batch", "7"},
                            {"--vary", "batch=1,2"},
                            {"--dry-run"},
                            {"--reference", "r.exr"},
                            {"--preset", "paper-table1"}}) {
    Words call = {"sweep", "-o", path("out"), "--advise", "--max-error", "1", "--quiet"};
    call.insert(call.end(), more.begin(), more.end());
    const Output output = run_gatelight_inside(call);
    expect_failure(output, 1, {more.front(), "SCENE"});
  }
}

TEST_F(SweepCommand, ResultsOfAnotherShapeAreRefused) {
  fs::create_directories(folder / "out/cells");
  for (const char* text : {R"({"schema": 2, "cells": [{"status": "done"}]})", R"({"schema": 2, "cells": 7})",
                           R"({"schema": 2, "cells": [{"status": "done", "errors": []}]})"}) {
    folder.write("out/results.json", text);
    const Output output = run_gatelight_inside({"sweep", "-o", path("out"), "--advise", "--max-error", "1"});
    expect_failure(output, 2, {path("out/results.json")});
  }
}

TEST_F(SweepCommand, ProgressReportsCellsTasksAndTimeLeft) {
  const Output output = run_gatelight_inside(loud(words("out", {})));
  ASSERT_EQ(output.exit_code, 0) << output.err;
  std::istringstream lines(output.err);
  std::map<std::string, int> events;
  json last_task;
  for (std::string line; std::getline(lines, line);) {
    const json event = json::parse(line);
    ++events[event["event"].get<std::string>()];
    if (event["event"] == "task") last_task = event;
  }
  EXPECT_EQ(events["cell"], 4);
  EXPECT_EQ(events["task"], 3);
  EXPECT_EQ(events["done"], 1);
  EXPECT_GT(events["progress"], 0);
  EXPECT_EQ(last_task["tasks_done"], 3);
  EXPECT_EQ(last_task["tasks"], 3);
  EXPECT_EQ(last_task["eta_seconds"], 0.0);
}

TEST_F(SweepCommand, AConfigurationFileMayHoldAxes) {
  const std::string file =
      folder
          .write("sweep.toml",
                 "train-steps = [2, 4]\nvary = [\"hidden=16,32\", \"features=2\"]\nsize = \"24x16\"\n")
          .string();
  const Output output = run_gatelight_inside(
      {"sweep", cornell(), "-o", path("out"), "--config", file, "--dry-run", "--no-plain"});
  EXPECT_EQ(output.exit_code, 0) << output.err;
  EXPECT_THAT(output.out, AllOf(HasSubstr("nrc gate hidden 16"), HasSubstr("24x16"), HasSubstr("steps 2,4")));
}

}  // namespace
}  // namespace gatelight::tests
