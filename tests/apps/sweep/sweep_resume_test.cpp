// Sweeps that fail, stop and go on.

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include "tests/apps/sweep/sweep_test.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SweepResume : public SweepTest {};

TEST_F(SweepResume, ASecondCallRepeatsNothing) {
  const json first = swept("out", {});
  const auto times = [&] {
    return times_of({folder / "out/cells", folder / "out/pictures", folder / "out/references"});
  };
  const auto before = times();
  swept("out", {});
  EXPECT_EQ(times(), before);
  EXPECT_EQ(results("out"), first);
  // A larger sweep adds only the missing cells.
  swept("out", {"--hidden", "16,32"});
  EXPECT_GT(times().size(), before.size());
  for (const auto& [file, time] : before) EXPECT_EQ(times().at(file), time) << file;
  // A cell whose picture is damaged is made again.
  const std::string picture = path("out/" + first["cells"][0]["picture"].get<std::string>());
  const std::string whole = read_file(picture);
  std::ofstream(picture, std::ios::binary) << whole.substr(0, whole.size() - 1);
  swept("out", {});
  EXPECT_EQ(read_file(picture), whole);
  // A record that is not a file cannot be replaced.
  const std::string record = path("out/cells/" + first["cells"][0]["id"].get<std::string>() + ".json");
  fs::remove(record);
  fs::create_directory(record);
  const Output output = run_gatelight_inside(words("out", {}));
  expect_failure(output, 3, {record});
}

TEST_F(SweepResume, AnotherSceneOfTheSameNameIsNotMixedUp) {
  const std::string scene = path("room.gltf");
  folder.write("room.gltf", tiny_scene());
  const json first = swept("out", {"--environment", "1,1,1"}, scene);
  std::string changed = tiny_scene();
  changed.replace(changed.find("[0.5, 0.5, 0.5, 1]"), 18, "[0.1, 0.1, 0.1, 1]");
  folder.write("room.gltf", changed);
  const json second = swept("out", {"--environment", "1,1,1"}, scene);
  ASSERT_EQ(second["cells"].size(), first["cells"].size());
  for (std::size_t i = 0; i < first["cells"].size(); ++i) {
    EXPECT_NE(second["cells"][i]["id"], first["cells"][i]["id"]);
  }
}

TEST_F(SweepResume, AFailedCellDoesNotEndTheRest) {
  // The first step already leaves answers that are not numbers.
  const Words flags = words("out", {"--learning-rate", "1e30,0.01", "--train-steps", "1,2,4"});
  const Output output = run_gatelight_inside(flags);
  expect_failure(output, 7, {"3", "8"});
  const json all = results("out");
  ASSERT_EQ(all["cells"].size(), 8u);
  for (const json& cell : all["cells"]) {
    const bool bad = cell["axes"].value("learning-rate", "") == "1e30";
    EXPECT_EQ(cell["status"], bad ? "failed" : "done");
    EXPECT_EQ(cell["error"].is_null(), !bad);
    if (!bad) continue;
    expect_message(cell["error"], {"training step 1"});
    EXPECT_TRUE(fs::exists(folder / ("out/cells/" + cell["id"].get<std::string>() + ".json")));
  }
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("failed"));
  // They are tried again, and fail again; the others stay.
  EXPECT_EQ(run_gatelight_inside(flags).exit_code, 7);
  EXPECT_EQ(results("out"), all);
}

TEST_F(SweepResume, ASceneThatCannotBeReadDoesNotEndTheRest) {
  folder.write("broken.gltf", "{");
  Words both = words("out", {}, path("broken.gltf"));
  both.insert(both.begin() + 2, cornell());
  const Output output = run_gatelight_inside(both);
  EXPECT_EQ(output.exit_code, 7);
  const json all = results("out");
  ASSERT_EQ(all["cells"].size(), 8u);
  for (const json& cell : all["cells"]) {
    EXPECT_EQ(cell["status"], cell["scene"] == "broken" ? "failed" : "done");
  }
  // By itself it is an error like any other.
  EXPECT_EQ(run_gatelight_inside(words("alone", {}, path("broken.gltf"))).exit_code, 2);
}

TEST_F(SweepResume, AnInterruptedAndResumedSweepHasTheSameResults) {
  const Words flags = {"--seeds", "3", "--hidden", "16,32", "--reference-spp", "256"};
  swept("straight", flags);
  const struct {
    const char* moment;
    int signal;
    int code;
  } stops[] = {
      {"reference path", SIGINT, 130}, {"\"event\":\"cell\"", SIGTERM, 143}, {"seed 2", SIGKILL, 137}};
  int interruptions = 0;
  std::map<std::string, fs::file_time_type> kept;
  for (const auto& stop : stops) {
    Process process(loud(words("stopped", flags)));
    process.wait_for_error_text(stop.moment);
    process.send(stop.signal);
    const Output output = process.finish();
    // The program may be quicker than the signal, but not always.
    EXPECT_TRUE(output.exit_code == stop.code || output.exit_code == 0) << output.err;
    interruptions += output.exit_code == stop.code ? 1 : 0;
    if (output.exit_code == 130 || output.exit_code == 143) {
      expect_message(output.last_error_line(), {std::to_string(output.exit_code - 128)});
      EXPECT_LT(results("stopped")["cells"].size(), 18u);
    }
    const auto now = times_of({folder / "stopped/cells"});
    for (const auto& [file, time] : kept) EXPECT_EQ(now.at(file), time) << file;
    kept = now;
  }
  EXPECT_GE(interruptions, 1);
  EXPECT_FALSE(kept.empty());
  swept("stopped", flags);
  EXPECT_EQ(without_seconds(results("stopped")), without_seconds(results("straight")));
  const auto finished = times_of({folder / "stopped/cells"});
  EXPECT_EQ(finished.size(), 18u);
  for (const auto& [file, time] : kept) EXPECT_EQ(finished.at(file), time) << file;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "stopped")) {
    const std::string name = entry.path().filename().string();
    EXPECT_THAT(name, AllOf(Not(HasSubstr(".tmp")), Not(HasSubstr("checkpoint"))));
  }
}

TEST_F(SweepResume, CellsOfAnEarlierCallStayInTheResultsOfAStoppedOne) {
  folder.write("room.gltf", tiny_scene());
  const auto both = [&](const std::string& hidden) {
    Words call = words("out", {"--hidden", hidden, "--environment", "1,1,1"});
    call.insert(call.begin() + 2, path("room.gltf"));
    return call;
  };
  const auto of_room = [](const json& all) {
    std::map<std::string, json> cells;
    for (const json& cell : all["cells"]) {
      if (cell["scene"] == "room") cells[cell["id"].get<std::string>()] = cell["errors"];
    }
    return cells;
  };
  ASSERT_EQ(run_gatelight_inside(both("16")).exit_code, 0);
  const auto before = of_room(results("out"));
  ASSERT_EQ(before.size(), 4u);
  // The room is the second scene of the call, and has not been reached yet.
  Process process(loud(both("16,32,64,128")));
  process.wait_for_error_text("\"event\":\"cell\"");
  process.send(SIGINT);
  EXPECT_EQ(process.finish().exit_code, 130);
  const json after = results("out");
  EXPECT_LT(after["cells"].size(), 20u);
  for (const auto& [id, errors] : before) EXPECT_EQ(of_room(after).at(id), errors);
  for (const json& cell : after["cells"])
    EXPECT_TRUE(cell["integrator"] == "path" || cell["axes"].contains("hidden"));
  EXPECT_EQ(after["scenes"][1]["references"].size(), 1u);
  EXPECT_THAT(read_file(folder / "out/report.html"), HasSubstr("<h2>room</h2>"));
}

TEST_F(SweepResume, TheReportIsWrittenAfterEachScene) {
  folder.write("room.gltf", tiny_scene());
  Words call = words("out", {"--environment", "1,1,1", "--seeds", "4"});
  call.insert(call.begin() + 1, path("room.gltf"));
  Process process(loud(call));
  ASSERT_TRUE(process.wait_for_error_text("\"task\":\"cornell-box reference"));
  process.send(SIGKILL);
  process.finish();
  EXPECT_THAT(read_file(folder / "out/report.html"), HasSubstr("<h2>room</h2>"));
}

TEST_F(SweepResume, OnlyOneSweepAtATimeUsesAFolder) {
  fs::create_directories(folder / "out");
  const int descriptor = ::open(path("out/.lock").c_str(), O_CREAT | O_RDWR, 0666);
  ASSERT_EQ(::flock(descriptor, LOCK_EX), 0);
  const Output second = run_gatelight_inside(words("out", {}));
  expect_failure(second, 2, {path("out")});
  EXPECT_EQ(count(folder / "out/cells"), 0u);
  EXPECT_EQ(run_gatelight_inside(words("out", {"--dry-run"})).exit_code, 0);
  ::close(descriptor);
  EXPECT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
}

TEST_F(SweepResume, CellsOfAnotherVersionAreKeptAndReported) {
  const json first = swept("out", {});
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string file = "out/cells/" + first["cells"][i]["id"].get<std::string>() + ".json";
    json cell = json::parse(read_file(folder / file));
    cell["version"] = "0.0.1";
    folder.write(file, cell.dump());
  }
  const auto before = times_of({folder / "out/cells"});
  Words call = words("out", {});
  std::erase(call, "--quiet");
  const Output output = run_gatelight_inside(call);
  EXPECT_EQ(output.exit_code, 0);
  expect_message(output.warnings().at(0), {"2", "0.0.1"});
  EXPECT_EQ(times_of({folder / "out/cells"}), before);
  EXPECT_EQ(results("out")["versions"]["of_cells"].size(), 2u);
  EXPECT_EQ(results("out")["versions"]["gatelight"], first["version"]);
}

TEST_F(SweepResume, OtherKernelsAreMeasuredAgain) {
  const json first = swept("out", {});
  ASSERT_EQ(::setenv("GATELIGHT_ISA", "scalar", 1), 0);
  const int code = run_gatelight_inside(words("out", {})).exit_code;
  ::unsetenv("GATELIGHT_ISA");
  ASSERT_EQ(code, 0);
  const json second = results("out");
  ASSERT_EQ(second["cells"].size(), first["cells"].size());
  for (std::size_t i = 0; i < first["cells"].size(); ++i) {
    EXPECT_EQ(second["cells"][i]["id"] == first["cells"][i]["id"], first["cells"][i]["integrator"] == "path");
  }
}

}  // namespace
}  // namespace gatelight::tests
