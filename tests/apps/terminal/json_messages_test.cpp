// With --progress json every line on stderr is an event, whatever happens.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::Not;

class JsonMessages : public FolderTest {
 protected:
  /// Throws where a line is no JSON.
  static std::vector<json> events(const Output& output) {
    std::vector<json> all;
    for (const std::string& line : output.error_lines()) all.push_back(json::parse(line));
    return all;
  }
  static std::vector<std::string> kinds(const std::vector<json>& events) {
    std::vector<std::string> kinds;
    for (const json& event : events) kinds.push_back(event.at("event"));
    return kinds;
  }

  Words words(const Words& more) const {
    return words_of("render {} -o {} --size 8x8 --spp 1", {scene, path("a.png")}, more);
  }
  /// The only event of a call that fails early.
  void expect_error(const Words& call, int code, const NameList& names,
                    Place place = Place::current()) const {
    const ::testing::ScopedTrace trace(place.file, place.line, "call");
    const Output output = run_gatelight_inside(call);
    EXPECT_EQ(output.exit_code, code);
    const std::vector<json> description = events(output);
    ASSERT_EQ(description.size(), 1u) << output.err;
    EXPECT_EQ(description[0]["event"], "error");
    EXPECT_EQ(description[0]["code"], code);
    EXPECT_NE(description[0]["advice"], "");
    expect_message(description[0]["message"], names, place);
  }

  std::string scene = folder.write("scene.gltf", tiny_scene());
};

TEST_F(JsonMessages, ARunIsReportedWithItsSummary) {
  const Output output =
      expect_done(run_gatelight(words({"--progress", "json", "--verbose", "--environment", "1,1,1"})));
  const std::vector<json> description = events(output);
  EXPECT_THAT(kinds(description), Contains("detail"));
  const json& done = description.back();
  EXPECT_EQ(done["event"], "done");
  EXPECT_EQ(done["outputs"], json({path("a.png")}));
  EXPECT_EQ(done["spp"], 1);
  EXPECT_EQ(done["samples"], 64);
  EXPECT_EQ(done["ended_by"], "spp");
  for (const char* key : {"seconds", "render_seconds", "samples_per_second", "rays", "peak_memory_bytes"})
    EXPECT_GT(done[key], 0) << key;
}

TEST_F(JsonMessages, WarningsAreEvents) {
  const std::vector<json> description =
      events(run_gatelight(words({"--progress=json", "--environment", "none", "--exposure", "0"})));
  const auto warning = std::find_if(description.begin(), description.end(),
                                    [](const json& e) { return e["event"] == "warning"; });
  ASSERT_NE(warning, description.end());
  expect_message((*warning)["message"], {scene, "light", "black"});
  EXPECT_EQ(run_gatelight(words({"--progress=json", "--environment", "none", "--quiet"})).err, "");
}

TEST_F(JsonMessages, ErrorsAreEventsWhereverTheyAreFound) {
  const std::vector<std::string> loud = {"--progress", "json"};
  const auto with = [&](Words more) {
    more.insert(more.end(), loud.begin(), loud.end());
    return words(more);
  };
  expect_error(with({"--frob"}), 1, {"--frob"});
  expect_error(with({"--clamp", "-1"}), 1, {"--clamp", "-1"});
  expect_error(with({"--resume"}), 1, {"--resume", "checkpoint"});
  expect_error(with({"--quiet", "--environment", path("none.exr")}), 2, {path("none.exr")});
  expect_error({"render", path("none.gltf"), "-o", path("a.png"), "--progress", "json"}, 2,
               {path("none.gltf")});
  expect_error({"render", scene, "--progress", "json"}, 1, {"--output"});
  expect_error({"sweep", scene, "--progress", "json"}, 1, {"--output"});
  expect_error({"sweep", "-o", path("out"), "--progress", "json"}, 1, {"SCENE"});
  expect_error({"sweep", "-o", path("out"), "--advise", "--max-time", "1", "--progress", "json"}, 2,
               {"results.json"});
  const std::string config = folder.write("c.toml", "progress = \"json\"\nsppp = 4\n");
  expect_error(words({"--config", config}), 1, {config, "sppp"});
  const std::string value = folder.write("v.toml", "progress = \"json\"\nclamp = -1\n");
  expect_error(words({"--config", value}), 1, {value, "--clamp"});
}

TEST_F(JsonMessages, EachCallSelectsThemForItself) {
  expect_error(words({"--progress", "json", "--clamp", "-1"}), 1, {"--clamp"});
  expect_failure(run_gatelight_inside(words({"--clamp", "-1"})), 1, {"--clamp"});
}

TEST_F(JsonMessages, ASignalIsANotice) {
  std::vector<std::string> endless = words({"--environment", "1,1,1", "--progress", "json"});
  std::replace(endless.begin(), endless.end(), std::string("1"), std::string("16777216"));
  Process run(endless);
  ASSERT_TRUE(run.wait_for_error_text("\"progress\""));
  run.send(SIGINT);
  const Output output = run.finish();
  EXPECT_EQ(output.exit_code, 130);
  const std::vector<json> description = events(output);
  EXPECT_EQ(description.back()["event"], "notice");
  EXPECT_EQ(description.back()["code"], 130);
  expect_message(description.back()["message"], {"signal 2", path("a.png")});
  EXPECT_THAT(kinds(description), Not(Contains("error")));
}

TEST_F(JsonMessages, ASweepEmitsWarningEventsToo) {
  const Words call = words_of(
      "sweep {} {} -o {} --size 8x8 --integrators path --spp 1 --reference-spp 2 --environment 1,1,1 "
      "--progress json",
      {scene, path("broken.gltf"), path("out")});
  const Output output = run_gatelight(call);
  EXPECT_EQ(output.exit_code, 2) << "a scene that is not there is found before the first cell";
  EXPECT_EQ(kinds(events(output)), std::vector<std::string>{"error"});
  folder.write("broken.gltf", "no scene");
  const Output partly = run_gatelight(call);
  EXPECT_EQ(partly.exit_code, 7) << partly.err;
  const std::vector<json> description = events(partly);
  EXPECT_THAT(kinds(description), Contains("warning"));
  EXPECT_EQ(description.back()["event"], "error");
  EXPECT_EQ(description.back()["code"], 7);
}

}  // namespace
}  // namespace gatelight::tests
