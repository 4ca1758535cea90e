// Small sweeps through the real program.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "renderer/image/image_read.h"
#include "tests/support/denoiser.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class SweepCommand : public ::testing::Test {
 protected:
  using Words = std::vector<std::string>;

  std::string path(const std::string& name) const { return (folder / name).string(); }
  static std::string cornell() { return std::string(GATELIGHT_SOURCE_DIR) + "/data/cornell-box.glb"; }

  /// A sweep of seconds; `more` wins.
  Words words(const std::string& out, const Words& more, const std::string& scene = cornell()) const {
    Words all = {"sweep", scene, "-o", path(out), "--quiet"};
    const Words defaults = {"--size",  "24x16", "--train-steps",   "2,4", "--spp",      "1,4",
                            "--batch", "256",   "--reference-spp", "8",   "--denoiser", "none"};
    // Rows of a preset set the denoiser themselves.
    const bool preset = std::find(more.begin(), more.end(), "--preset") != more.end();
    for (std::size_t i = 0; i < defaults.size(); i += 2) {
      if (preset && defaults[i] == "--denoiser") continue;
      if (std::find(more.begin(), more.end(), defaults[i]) != more.end()) continue;
      all.insert(all.end(), {defaults[i], defaults[i + 1]});
    }
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Prints cells and tasks as JSON.
  static Words loud(Words call) {
    std::erase(call, "--quiet");
    call.insert(call.end(), {"--progress", "json"});
    return call;
  }
  json results(const std::string& out) const {
    return json::parse(read_file(folder / (out + "/results.json")));
  }
  /// A cell of the sweep in "out" is the picture that its command makes.
  void expect_picture_of_its_command(const json& cell) const {
    std::istringstream line(cell["command"].get<std::string>());
    Words command;
    for (std::string word; line >> word;) command.push_back(word);
    command.erase(command.begin());
    command.back() = path("cell.png");
    command.push_back("--quiet");
    ASSERT_EQ(run_gatelight_inside(command).exit_code, 0) << line.str();
    EXPECT_EQ(read_file(path("cell.png")), read_file(folder / ("out/" + cell["picture"].get<std::string>())))
        << line.str();
  }

  TemporaryFolder folder;
};

/// Noise of the reference with this key.
double noise_of(const json& results, const std::string& id) {
  for (const json& reference : results["scenes"][0]["references"]) {
    if (reference["id"] == id) return reference["rel_mse_noise"];
  }
  ADD_FAILURE() << "there is no reference " << id;
  return 0.0;
}

/// When each file in the folders was written.
std::map<std::string, fs::file_time_type> times_of(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::file_time_type> found;
  for (const fs::path& folder : folders) {
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder))
      found[entry.path().string()] = entry.last_write_time();
  }
  return found;
}

/// The results without the command and times, which differ between two runs.
json without_seconds(json results) {
  results.erase("command");
  for (json& scene : results["scenes"]) {
    for (json& reference : scene["references"]) reference.erase("seconds");
  }
  for (json& cell : results["cells"]) {
    for (const char* key : {"seconds", "train_ms_per_step", "train_step_ms", "query_ms_per_2m",
                            "equal_seconds", "times_faster", "extrapolated"})
      cell.erase(key);
  }
  return results;
}

std::size_t count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST_F(SweepCommand, TheReportContainsEveryPicture) {
  ASSERT_EQ(run_gatelight(words("out", {"--seeds", "2"})).exit_code, 0);
  const std::string report = read_file(folder / "out/report.html");
  const std::string open = R"(<script type="application/json" id="pictures">)";
  ASSERT_THAT(report, HasSubstr(open));
  const std::size_t begin = report.find(open) + open.size();
  std::set<std::string> shown;
  for (const json& entry : json::parse(report.substr(begin, report.find("</script>", begin) - begin))) {
    shown.insert(entry["file"].get<std::string>());
  }
  std::set<std::string> named;
  const json all = results("out");
  for (const json& cell : all["cells"]) {
    for (const char* key : {"picture", "error_map"}) {
      if (cell[key].is_string()) named.insert(cell[key].get<std::string>());
    }
  }
  for (const json& reference : all["scenes"][0]["references"])
    named.insert(reference["file"].get<std::string>());
  EXPECT_EQ(named.size(), 4u * 2u + 1u);
  EXPECT_EQ(shown, named);
}

TEST_F(SweepCommand, MeasuresEveryCellAgainstItsReference) {
  const Output output =
      run_gatelight_inside(words("out", {"--encodings", "gate,hashgrid", "--cache-memory", "same-as-gate",
                                         "--seeds", "2", "--integrators", "nrc,nao"}));
  ASSERT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(output.out + output.err, "");
  const json all = results("out");
  // Two integrators by two encodings, path and ao: six lines with two points and two seeds each.
  ASSERT_EQ(all["cells"].size(), 24u);
  EXPECT_EQ(count(folder / "out/cells"), 24u);
  EXPECT_EQ(count(folder / "out/pictures"), 24u) << "a picture and a map of the first seed";
  std::map<std::string, std::set<std::size_t>> parameters;
  for (const json& cell : all["cells"]) {
    EXPECT_EQ(cell["status"], "done");
    EXPECT_GT(cell["errors"]["flip"], 0.0);
    EXPECT_LT(cell["errors"]["ssim"], 1.0);
    EXPECT_NEAR(cell["errors"]["rel_mse"].get<double>() - cell["errors"]["rel_mse_clean"].get<double>(),
                noise_of(all, cell["reference_id"]), 1e-12);
    EXPECT_GT(cell["seconds"]["total"], 0.0);
    EXPECT_EQ(cell["picture"].is_null(), cell["seed"] != 1);
    EXPECT_EQ(cell["errors"]["hdr_flip"].is_null(), cell["reference"] == "ao");
    if (cell["encoding"].is_string()) {
      const std::size_t bytes = cell["memory_bytes"]["parameters"];
      parameters[cell["integrator"].get<std::string>()].insert(bytes);
      if (cell["encoding"] == "hashgrid") {
        EXPECT_GT(cell["options"]["cache-memory"], 0.0);
      }
    }
    if (!cell["picture"].is_null()) {
      EXPECT_EQ(renderer::read_image(folder / ("out/" + cell["picture"].get<std::string>())).width, 24);
      EXPECT_EQ(renderer::read_image(folder / ("out/" + cell["error_map"].get<std::string>())).width, 24);
    }
  }
  // As near as the sizes of tables allow.
  for (const auto& [integrator, bytes] : parameters) {
    EXPECT_LT(static_cast<double>(*bytes.rbegin()), 1.3 * static_cast<double>(*bytes.begin())) << integrator;
  }
  ASSERT_EQ(all["scenes"].size(), 1u);
  EXPECT_EQ(all["scenes"][0]["name"], "cornell-box");
  ASSERT_EQ(all["scenes"][0]["references"].size(), 2u);
  for (const json& reference : all["scenes"][0]["references"]) {
    EXPECT_GT(reference["rel_mse_noise"], 0.0);
    EXPECT_EQ(reference["spp"], 8);
    EXPECT_TRUE(fs::exists(folder / ("out/" + reference["file"].get<std::string>())));
  }
  EXPECT_EQ(std::count(all["command"].begin(), all["command"].end(), "sweep"), 1);
}

TEST_F(SweepCommand, ACellIsThePictureThatItsCommandMakes) {
  ASSERT_EQ(run_gatelight_inside(words("out", {"--features", "2,4"})).exit_code, 0);
  const json all = results("out");
  for (const json& cell : all["cells"]) {
    ASSERT_NO_FATAL_FAILURE(expect_picture_of_its_command(cell));
  }
}

/// A sweep by default measures the bare and the finished cache beside path tracing of both kinds.
class SweepOfASceneAlone : public SweepCommand {
 protected:
  void SetUp() override { GATELIGHT_NEEDS_DENOISER(); }
  Words all_rows(const std::string& out) const {
    Words call = words(out, {});
    const auto at = std::find(call.begin(), call.end(), "--denoiser");
    call.erase(at, at + 2);
    return call;
  }
};

TEST_F(SweepOfASceneAlone, ContainsTheFinishedPicturesThatTheCommandsMake) {
  const Output output = run_gatelight_inside(all_rows("out"));
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const json all = results("out");
  std::map<std::string, int> cells;
  for (const json& cell : all["cells"]) {
    ++cells[cell["series"].get<std::string>()];
    const bool finished = cell["options"]["denoiser"] == "oidn";
    EXPECT_EQ(cell["axes"]["denoiser"], finished ? "oidn" : "none");
    EXPECT_EQ(cell["seconds"]["denoise"].is_number(), finished);
    const json& seconds = cell["seconds"];
    double sum = 0.0;
    for (const char* phase : {"scout", "setup", "train", "render", "denoise"}) {
      if (seconds[phase].is_number()) sum += seconds[phase].get<double>();
    }
    EXPECT_NEAR(seconds["total"].get<double>(), sum, 1e-9);
    EXPECT_EQ(cell["reference_id"], all["scenes"][0]["references"][0]["id"]);
    if (cell["series"] == "nrc bare" || (cell["series"] == "path" && cell["spp"] == 1)) continue;
    ASSERT_NO_FATAL_FAILURE(expect_picture_of_its_command(cell));
  }
  EXPECT_EQ(cells, (std::map<std::string, int>{{"path", 2},
                                               {"path denoised", 2},
                                               {"nrc bare", 2},
                                               {"nrc standard spp 2", 2},
                                               {"nrc standard spp 7", 2},
                                               {"nrc standard spp 28", 2}}));
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("axis_denoiser"));
}

TEST_F(SweepOfASceneAlone, ResumesAfterAStopAndSharesCellsWithASmallerSweep) {
  ASSERT_EQ(run_gatelight_inside(all_rows("straight")).exit_code, 0);
  Process process(loud(all_rows("out")));
  process.wait_for_error_text("\"event\":\"cell\"");
  process.send(SIGTERM);
  process.finish();
  const auto before = times_of({folder / "out/cells"});
  ASSERT_EQ(run_gatelight_inside(all_rows("out")).exit_code, 0);
  const auto after = times_of({folder / "out/cells"});
  for (const auto& [file, time] : before) EXPECT_EQ(after.at(file), time) << file;
  EXPECT_EQ(after.size(), 12u);
  EXPECT_EQ(without_seconds(results("out")), without_seconds(results("straight")));
  // Path tracing as traced is the same cell in any sweep.
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  EXPECT_EQ(times_of({folder / "out/cells"}).size(), 12u + 2u);
}

TEST_F(SweepOfASceneAlone, AdviceIncludesFinishedPictures) {
  Words call = all_rows("out");
  ASSERT_EQ(run_gatelight_inside(call).exit_code, 0);
  const json all = results("out");
  const auto least = [](const json& a, const json& b) { return a["errors"]["flip"] < b["errors"]["flip"]; };
  const json& best = *std::min_element(all["cells"].begin(), all["cells"].end(), least);
  // Whichever is the best at 24x24, finished ones are among those that it is chosen from.
  EXPECT_TRUE(std::any_of(all["cells"].begin(), all["cells"].end(),
                          [](const json& cell) { return cell["options"]["denoiser"] == "oidn"; }));
  const Output advice = run_gatelight_inside({"sweep", "-o", path("out"), "--advise", "--max-time", "1000"});
  EXPECT_EQ(advice.exit_code, 0) << advice.err;
  EXPECT_THAT(advice.out, AllOf(HasSubstr("cornell-box (path): " + best["series"].get<std::string>()),
                                HasSubstr("\n  " + best["command"].get<std::string>() + "\n")));
}

TEST_F(SweepCommand, ASecondCallRepeatsNothing) {
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  const json first = results("out");
  const auto times = [&] {
    return times_of({folder / "out/cells", folder / "out/pictures", folder / "out/references"});
  };
  const auto before = times();
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  EXPECT_EQ(times(), before);
  EXPECT_EQ(results("out"), first);
  // A larger sweep adds only the missing cells.
  ASSERT_EQ(run_gatelight_inside(words("out", {"--hidden", "16,32"})).exit_code, 0);
  EXPECT_GT(times().size(), before.size());
  for (const auto& [file, time] : before) EXPECT_EQ(times().at(file), time) << file;
  // A cell whose picture was deleted is made again.
  const std::string picture = path("out/" + first["cells"][0]["picture"].get<std::string>());
  const std::string whole = read_file(picture);
  fs::remove(picture);
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  EXPECT_EQ(read_file(picture), whole);
  // So is one whose picture is damaged.
  for (const std::size_t length : {std::size_t{0}, std::size_t{50}, whole.size() - 1}) {
    std::ofstream(picture, std::ios::binary) << whole.substr(0, length);
    const Output output = run_gatelight_inside(words("out", {}));
    ASSERT_EQ(output.exit_code, 0) << output.err;
    EXPECT_EQ(read_file(picture), whole) << length;
  }
  // A record that is not a file cannot be replaced.
  const std::string record = path("out/cells/" + first["cells"][0]["id"].get<std::string>() + ".json");
  fs::remove(record);
  fs::create_directory(record);
  const Output output = run_gatelight_inside(words("out", {}));
  expect_failure(output, 3, {record});
}

TEST_F(SweepCommand, AnotherSceneOfTheSameNameIsNotMixedUp) {
  const std::string scene = path("room.gltf");
  folder.write("room.gltf", tiny_scene());
  ASSERT_EQ(run_gatelight_inside(words("out", {"--environment", "1,1,1"}, scene)).exit_code, 0);
  const json first = results("out");
  std::string changed = tiny_scene();
  changed.replace(changed.find("[0.5, 0.5, 0.5, 1]"), 18, "[0.1, 0.1, 0.1, 1]");
  folder.write("room.gltf", changed);
  ASSERT_EQ(run_gatelight_inside(words("out", {"--environment", "1,1,1"}, scene)).exit_code, 0);
  const json second = results("out");
  ASSERT_EQ(second["cells"].size(), first["cells"].size());
  for (std::size_t i = 0; i < first["cells"].size(); ++i) {
    EXPECT_NE(second["cells"][i]["id"], first["cells"][i]["id"]);
  }
}

TEST_F(SweepCommand, AFailedCellDoesNotEndTheRest) {
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

TEST_F(SweepCommand, ASceneThatCannotBeReadDoesNotEndTheRest) {
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

TEST_F(SweepCommand, AnInterruptedAndResumedSweepHasTheSameResults) {
  const Words flags = {"--seeds", "3", "--hidden", "16,32", "--reference-spp", "256"};
  ASSERT_EQ(run_gatelight_inside(words("straight", flags)).exit_code, 0);
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
      expect_names(output.last_error_line(), {std::to_string(output.exit_code - 128)});
      EXPECT_LT(results("stopped")["cells"].size(), 18u);
    }
    const auto now = times_of({folder / "stopped/cells"});
    for (const auto& [file, time] : kept) EXPECT_EQ(now.at(file), time) << file;
    kept = now;
  }
  EXPECT_GE(interruptions, 1);
  EXPECT_FALSE(kept.empty());
  ASSERT_EQ(run_gatelight_inside(words("stopped", flags)).exit_code, 0);
  EXPECT_EQ(without_seconds(results("stopped")), without_seconds(results("straight")));
  const auto finished = times_of({folder / "stopped/cells"});
  EXPECT_EQ(finished.size(), 18u);
  for (const auto& [file, time] : kept) EXPECT_EQ(finished.at(file), time) << file;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "stopped")) {
    const std::string name = entry.path().filename().string();
    EXPECT_THAT(name, AllOf(Not(HasSubstr(".tmp")), Not(HasSubstr("checkpoint"))));
  }
  for (const auto& entry : fs::directory_iterator(folder / "stopped/references")) {
    if (entry.path().extension() != ".exr") continue;
    EXPECT_EQ(
        renderer::read_image(entry.path()).layers[0].values,
        renderer::read_image(folder / "straight/references" / entry.path().filename()).layers[0].values);
  }
}

TEST_F(SweepCommand, CellsOfAnEarlierCallStayInTheResultsOfAStoppedOne) {
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
  EXPECT_THAT(read_file(folder / "out/report.html"), HasSubstr(before.begin()->first));
}

TEST_F(SweepCommand, TheReportIsWrittenAfterEachScene) {
  folder.write("room.gltf", tiny_scene());
  Words call = words("out", {"--environment", "1,1,1", "--seeds", "4"});
  call.insert(call.begin() + 1, path("room.gltf"));
  Process process(loud(call));
  ASSERT_TRUE(process.wait_for_error_text("\"task\":\"cornell-box reference"));
  process.send(SIGKILL);
  process.finish();
  EXPECT_THAT(read_file(folder / "out/report.html"), HasSubstr("\"scene\":\"room\""));
}

TEST_F(SweepCommand, OnlyOneSweepAtATimeUsesAFolder) {
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

TEST_F(SweepCommand, CellsOfAnotherVersionAreKeptAndReported) {
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  const json first = results("out");
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

TEST_F(SweepCommand, OtherKernelsAreMeasuredAgain) {
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  const json first = results("out");
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

TEST_F(SweepCommand, ResultsNameTheVersionsAndTheChosenOptions) {
  ASSERT_EQ(run_gatelight_inside(words("out", {"--isa", "scalar", "--threads", "1"})).exit_code, 0);
  const json all = results("out");
  EXPECT_EQ(all["machine"]["isa"], "scalar");
  EXPECT_EQ(all["machine"]["threads"], 1);
  EXPECT_NE(all["versions"]["embree"], "");
  for (const json& cell : all["cells"]) {
    EXPECT_EQ(cell["isa"], "scalar");
    EXPECT_EQ(cell["cpu"], all["machine"]["cpu"]);
    EXPECT_EQ(cell["version"], all["version"]);
    EXPECT_EQ(cell["options"]["isa"], "scalar");
    for (const auto& [option, value] : cell["options"].items()) {
      EXPECT_TRUE(value != "auto" || option == "cluster" || option == "environment") << option;
    }
  }
}

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

TEST_F(SweepCommand, AGivenReferenceIsCompared) {
  ASSERT_EQ(run_gatelight_inside({"render", cornell(), "-o", path("r.exr"), "--size", "24x16", "--spp", "16",
                                  "--seed", "77", "--quiet"})
                .exit_code,
            0);
  ASSERT_EQ(run_gatelight_inside(words("out", {"--reference", path("r.exr"), "--no-plain"})).exit_code, 0);
  const json all = results("out");
  EXPECT_EQ(all["cells"].size(), 2u);
  EXPECT_TRUE(all["cells"][0]["errors"]["rel_mse_clean"].is_null());
  EXPECT_EQ(all["scenes"][0]["references"][0]["file"], path("r.exr"));
  EXPECT_EQ(all["scenes"][0]["references"][0]["spp"], 16);
  EXPECT_FALSE(fs::exists(folder / "out/references"));
  EXPECT_EQ(all["cells"][0]["reference_id"], all["scenes"][0]["references"][0]["id"]);
  // A reference that fits no cell is reported before the first cell is made.
  const auto refused = [&](const Words& more) {
    Words flags = {"--reference", path("r.exr"), "--no-plain"};
    flags.insert(flags.end(), more.begin(), more.end());
    const Output output = run_gatelight_inside(words("other", flags));
    EXPECT_NE(output.exit_code, 0);
    EXPECT_EQ(count(folder / "other/cells"), 0u);
    return output;
  };
  const Output size = refused({"--size", "20x16"});
  expect_failure(size, 2, {"r.exr", "24x16", "20x16"});
  for (const char* vary : {"max-depth=2,3", "filter=box,tent", "environment=none;1,1,1", "fov=40,50"}) {
    const Output views = refused({"--vary", vary});
    expect_failure(views, 1, {"--reference", path("r.exr"), "2", "--reference-spp"});
  }
  const Output missing = run_gatelight_inside(words("out", {"--reference", path("none.exr"), "--no-plain"}));
  expect_failure(missing, 2, {"none.exr"});
}

TEST_F(SweepCommand, NamedRunsAreMeasuredWithTheirBias) {
  Words call = words("out", {"--run", "cached: --integrator nrc --query-at primary --train-steps 8", "--run",
                             "two: --spp 2", "--keep-exr", "--seeds", "2", "--reference-spp", "256"});
  const auto steps = std::find(call.begin(), call.end(), "--train-steps");
  call.erase(steps, steps + 2);
  const Output output = run_gatelight_inside(call);
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const json all = results("out");
  std::map<std::string, json> second;
  for (const json& cell : all["cells"]) {
    EXPECT_TRUE(fs::exists(folder / ("out/pictures/" + cell["id"].get<std::string>() + ".exr")));
    EXPECT_EQ(cell["errors"]["bias_rel_mse"].is_null(), cell["seed"] == 1);
    if (cell["seed"] == 2) second[cell["run"].get<std::string>()] = cell;
    if (cell["seed"] == 1) {
      ASSERT_NO_FATAL_FAILURE(expect_picture_of_its_command(cell));
    }
  }
  ASSERT_EQ(second.size(), 4u) << "path with 1 and 4 samples, and the runs";
  const auto error = [&](const char* run, const char* key) {
    return second.at(run)["errors"][key].get<double>();
  };
  // A cache of eight steps is biased, and paths are not.
  EXPECT_GT(error("cached", "bias_rel_mse"), 0.5 * error("cached", "rel_mse_clean"));
  EXPECT_LT(std::abs(error("path, 4 spp", "bias_rel_mse")), 0.5 * error("path, 4 spp", "rel_mse_clean"));
  EXPECT_GT(error("path, 1 spp", "rel_mse_clean"), error("two", "rel_mse_clean"));
  EXPECT_GT(error("two", "rel_mse_clean"), error("path, 4 spp", "rel_mse_clean"));
  EXPECT_EQ(second.at("cached")["train_steps"], 8);
  // The bias is that of `compare --halves`.
  const std::string reference =
      path("out/references/" + all["scenes"][0]["references"][0]["id"].get<std::string>());
  const auto exr = [&](const json& cell) {
    return path("out/pictures/" + cell["id"].get<std::string>() + ".exr");
  };
  std::string first;
  for (const json& cell : all["cells"]) {
    if (cell["run"] == "cached" && cell["seed"] == 1) first = exr(cell);
  }
  const Output compared =
      run_gatelight_inside({"compare", reference + "_a.exr", first, "--halves", reference + "_b.exr",
                            exr(second.at("cached")), "--json", "-", "--metric", "rel_mse"});
  EXPECT_NEAR(json::parse(compared.out)["bias_rel_mse"].get<double>(), error("cached", "bias_rel_mse"),
              1e-12);
  EXPECT_THAT(read_file(folder / "out/results.md"),
              AllOf(HasSubstr("| | cached | two |\n"), HasSubstr("|  | cached | ")));
  // Nothing is made again, except a pair whose picture is missing.
  const auto before = times_of({folder / "out/cells", folder / "out/pictures"});
  ASSERT_EQ(run_gatelight_inside(call).exit_code, 0);
  EXPECT_EQ(times_of({folder / "out/cells", folder / "out/pictures"}), before);
  fs::remove(first);
  ASSERT_EQ(run_gatelight_inside(call).exit_code, 0);
  EXPECT_TRUE(fs::exists(first));
  EXPECT_EQ(without_seconds(results("out"))["cells"].size(), all["cells"].size());
  // The same reference from elsewhere, as its halves.
  Words given = call;
  given[3] = path("given");
  given.insert(given.end(), {"--reference", reference + "_a.exr", "--reference", reference + "_b.exr"});
  ASSERT_EQ(run_gatelight_inside(given).exit_code, 0);
  const json again = results("given");
  for (std::size_t i = 0; i < all["cells"].size(); ++i)
    EXPECT_EQ(again["cells"][i]["errors"], all["cells"][i]["errors"]);
}

TEST_F(SweepCommand, SweepsMayShareAFolderOfReferences) {
  const Words shared = {"--reference-dir", path("shared"), "--no-plain"};
  ASSERT_EQ(run_gatelight_inside(words("a", shared)).exit_code, 0);
  ASSERT_EQ(count(folder / "shared"), 4u);
  const std::string file = results("a")["scenes"][0]["references"][0]["file"];
  EXPECT_EQ(fs::path(file).parent_path(), folder / "shared");
  const auto time = fs::last_write_time(file);
  ASSERT_EQ(run_gatelight_inside(words("b", shared)).exit_code, 0);
  EXPECT_EQ(fs::last_write_time(file), time);
  EXPECT_EQ(without_seconds(results("a")), without_seconds(results("b")));
}

TEST_F(SweepCommand, TheBareCacheIsComparedWithWhatItShouldAnswer) {
  ASSERT_EQ(
      run_gatelight_inside(words("out", {"--preset", "paper-nrc", "--train-steps", "8", "--batch", "1024"}))
          .exit_code,
      0);
  const json all = results("out");
  ASSERT_EQ(all["cells"].size(), 1u);
  EXPECT_EQ(all["cells"][0]["reference"], "cache");
  EXPECT_EQ(all["scenes"][0]["references"][0]["kind"], "cache");
  EXPECT_LT(all["cells"][0]["errors"]["flip"], 0.9);
}

TEST_F(SweepCommand, AdviceNeedsNeitherSceneNorTime) {
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  const Output one = run_gatelight_inside({"sweep", "-o", path("out"), "--advise", "--max-error", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.out, AllOf(HasSubstr("cornell-box (path): "), HasSubstr("\n  gatelight render "),
                             HasSubstr("-o out.exr\n")));
  const Output none = run_gatelight_inside(words("out", {"--advise", "--max-error", "0"}));
  EXPECT_THAT(none.out, HasSubstr("none of 4 met it; the nearest is"));
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
  // A cell is made again.
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  const json first = results("out");
  folder.write("out/cells/" + first["cells"][0]["id"].get<std::string>() + ".json", R"({"status": null})");
  ASSERT_EQ(run_gatelight_inside(words("out", {})).exit_code, 0);
  EXPECT_EQ(without_seconds(results("out")), without_seconds(first));
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

TEST_F(SweepCommand, HelpNamesAxesOutputAndPresets) {
  const Output output = run_gatelight_inside({"sweep", "--help"});
  EXPECT_EQ(output.exit_code, 0);
  for (const char* word : {"--train-steps LIST", "--encodings LIST", "--vary NAME=LIST", "--seeds N",
                           "--reference FILE", "--advise", "--max-error FLIP", "--dry-run", "paper-table1",
                           "results.csv", "report.html", "Examples:"}) {
    EXPECT_THAT(output.out, HasSubstr(word));
  }
  EXPECT_THAT(output.out, Not(HasSubstr("--batch N")));
}

}  // namespace
}  // namespace gatelight::tests
