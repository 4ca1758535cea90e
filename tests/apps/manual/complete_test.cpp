// Words that may follow on the command line, as the scripts of the shells ask for them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/manual/help_flags.h"
#include "tests/support/folder_test.h"
#include "tests/support/process.h"
#include "tests/support/tiny_scene.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

struct Answer {
  std::vector<std::string> words;
  std::string kind;  ///< the last line
};

Answer completed(std::vector<std::string> words) {
  words.insert(words.begin(), {"__complete", "--"});
  const Output output = run_gatelight_inside(words);
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_EQ(output.err, "");
  Answer answer;
  std::istringstream lines(output.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(':')) {
      answer.kind = line;
    } else {
      answer.words.push_back(line.substr(0, line.find('\t')));
    }
  }
  return answer;
}

class Complete : public FolderTest {
 protected:
  /// The tiny scene with more cameras: of a name with a space, with a node's name only, and of no name.
  json scene() const {
    json file = json::parse(tiny_scene());
    const json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
    for (int i = 0; i < 3; ++i) {
      file["cameras"].push_back(camera);
      file["nodes"].push_back({{"camera", i + 1}});
      file["scenes"][0]["nodes"].push_back(i + 2);
    }
    file["cameras"][1]["name"] = "Camera 1";
    file["nodes"][3]["name"] = "door";
    return file;
  }
};

TEST_F(Complete, SubcommandsComeFirst) {
  EXPECT_THAT(completed({""}).words, IsSupersetOf({"render", "compare", "info", "merge", "denoise", "view",
                                                   "sweep", "completion", "manual"}));
  EXPECT_THAT(completed({"re"}).words, ElementsAre("render"));
  EXPECT_THAT(completed({"--v"}).words, ElementsAre("--version"));
  EXPECT_THAT(completed({"--config", "a.toml", "mer"}).words, ElementsAre("merge"));
  EXPECT_THAT(completed({"frobnicate", "--s"}).words, IsEmpty());
  EXPECT_THAT(completed({}).words, Contains("render"));
}

TEST_F(Complete, EveryFlagOfTheHelpIsOffered) {
  for (const std::string& name : subcommands()) {
    const std::vector<std::string> offered = completed({name, "-"}).words;
    for (const std::string& flag : flags_of(name)) EXPECT_THAT(offered, Contains(flag)) << name;
  }
}

TEST_F(Complete, ASweepTakesTheFlagsOfRenderWithTheirValues) {
  EXPECT_THAT(completed({"sweep", "a.glb", "--to"}).words, ElementsAre("--tonemap"));
  EXPECT_THAT(completed({"sweep", "a.glb", "--tonemap", "a"}).words, ElementsAre("aces", "agx"));
  EXPECT_THAT(completed({"sweep", "--encodings", "gate,"}).words, ElementsAre("gate,hashgrid"));
  EXPECT_THAT(completed({"sweep", "--vary", "integ"}).words, ElementsAre("integrator="));
  EXPECT_EQ(completed({"sweep", "--vary", "integ"}).kind, ":open");
  EXPECT_THAT(completed({"sweep", "--vary", "encoding=h"}).words, ElementsAre("encoding=hashgrid"));
  EXPECT_THAT(completed({"sweep", "--preset", "paper-table"}).words,
              ElementsAre("paper-table1", "paper-table2"));
}

TEST_F(Complete, ChoicesAreValues) {
  EXPECT_THAT(completed({"render", "--integrator", ""}).words,
              ElementsAre("path", "ao", "nao", "nrc", "auto"));
  EXPECT_THAT(completed({"render", "--integrator", "na"}).words, ElementsAre("nao"));
  EXPECT_THAT(completed({"render", "--integrator=na"}).words, ElementsAre("--integrator=nao"));
  EXPECT_THAT(completed({"render", "--max-depth", ""}).words, ElementsAre("none"));
  EXPECT_THAT(completed({"render", "--device", ""}).words, ElementsAre("cpu", "vulkan"));
  EXPECT_THAT(completed({"render", "--eye", ""}).words, IsEmpty());
  EXPECT_THAT(completed({"completion", ""}).words, ElementsAre("bash", "zsh", "fish"));
  EXPECT_THAT(completed({"manual", "m"}).words, ElementsAre("merge", "manual", "mpi"));
  const Answer resolution = completed({"render", "--resolution", "f"});
  EXPECT_THAT(resolution.words, ElementsAre("fixed:"));
  EXPECT_EQ(resolution.kind, ":open") << "a number follows";
}

TEST_F(Complete, ListsGoOnWithNamesThatTheyLack) {
  const Answer layers = completed({"render", "--aov", "albedo,n"});
  EXPECT_THAT(layers.words, ElementsAre("albedo,normal", "albedo,nearest-node"));
  EXPECT_EQ(layers.kind, ":open");
  EXPECT_THAT(completed({"render", "--aov=normal,n"}).words, ElementsAre("--aov=normal,nearest-node"));
  EXPECT_THAT(completed({"render", "--cryptomatte", ""}).words, ElementsAre("object", "material"));
  EXPECT_THAT(completed({"compare", "--metric", "flip,h"}).words, ElementsAre("flip,hdr_flip"));
}

TEST_F(Complete, FilesHaveTheExtensionsOfTheHelp) {
  EXPECT_EQ(completed({"render", ""}).kind, ":files\t0\tgltf glb");
  EXPECT_EQ(completed({"render", "a.glb", "-o", ""}).kind, ":files\t0\texr png jpg tif hdr");
  EXPECT_EQ(completed({"render", "--config", ""}).kind, ":files\t0\ttoml");
  EXPECT_EQ(completed({"render", "--config=a"}).kind, ":files\t9\ttoml");
  EXPECT_EQ(completed({"render", "--stats", ""}).kind, ":files\t0\t");
  EXPECT_EQ(completed({"render", "--ies", "lamp="}).kind, ":files\t5\t");
  EXPECT_EQ(completed({"render", "--ies", "lamp"}).kind, ":words");
  EXPECT_EQ(completed({"compare", "--halves", "a.exr", ""}).kind, ":words") << "a second value";
  EXPECT_EQ(completed({"compare", "a.exr", ""}).kind, ":files\t0\texr hdr png");
  EXPECT_EQ(completed({"merge", "-o", "a.exr", "b.exr", ""}).kind, ":files\t0\texr");
  EXPECT_EQ(completed({"sweep", "-o", ""}).kind, ":folders\t0");
  const Answer environment = completed({"render", "--environment", ""});
  EXPECT_THAT(environment.words, ElementsAre("auto", "none"));
  EXPECT_EQ(environment.kind, ":files\t0\texr hdr");
}

TEST_F(Complete, AFlagIsOfferedOnceUnlessItMayBeRepeated) {
  EXPECT_THAT(completed({"render", "--quiet", "--output", "a.png", "-"}).words,
              AllOf(Contains("--output"), Not(Contains("--quiet"))));
  EXPECT_THAT(completed({"render", "--spp=4", "--sp"}).words, ElementsAre("--spread-threshold"));
  EXPECT_THAT(completed({"render", "a.glb", ""}).words, Contains("--spp")) << "no other word may follow";
  EXPECT_THAT(completed({"render", "--", "--spp", ""}).words, Contains("--spp")) << "'--spp' is the scene";
}

TEST_F(Complete, CamerasAreThoseOfTheScene) {
  const std::string file = folder.write("a room.gltf", scene().dump());
  EXPECT_THAT(completed({"render", file, "--camera", ""}).words,
              ElementsAre("all", "front", "Camera 1", "door"));
  EXPECT_THAT(completed({"render", file, "--camera=C"}).words, ElementsAre("--camera=Camera 1"));
  EXPECT_THAT(completed({"sweep", file, "--camera", "f"}).words, ElementsAre("front"));
  EXPECT_THAT(completed({"render", path("none.glb"), "--camera", ""}).words, ElementsAre("all"));
  EXPECT_THAT(completed({"render", "--camera", ""}).words, ElementsAre("all"));
}

TEST_F(Complete, CamerasOfAFileAreThoseOfItsReport) {
  int cameras = 0;
  for (const auto& entry : std::filesystem::directory_iterator(GATELIGHT_SOURCE_DIR "/data")) {
    if (entry.path().extension() != ".glb") continue;
    std::vector<std::string> words = {"all"};
    const json report = json::parse(run_gatelight({"info", entry.path(), "--json", "-"}).out);
    for (const json& camera : report["cameras"]) words.push_back(camera["name"]);
    EXPECT_THAT(completed({"render", entry.path(), "--camera", ""}).words,
                ::testing::UnorderedElementsAreArray(words))
        << entry.path();
    cameras += static_cast<int>(words.size()) - 1;
  }
  EXPECT_GT(cameras, 5);
}

TEST_F(Complete, BrokenFilesHaveNoCameras) {
  const auto cameras = [&](const std::string& content) {
    return completed({"render", folder.write("broken.glb", content), "--camera", ""}).words;
  };
  json file = scene();
  const std::string good = file.dump();
  EXPECT_THAT(cameras(good), Contains("door"));
  for (const std::string& content :
       {std::string(), good.substr(0, 300), std::string("[]"), std::string("glTF"),
        "glTF" + std::string(16, '\xff'), "glTF" + std::string(8, '\0') + "\x40\x1f\0\0JSON" + good}) {
    EXPECT_THAT(cameras(content), ElementsAre("all")) << content.substr(0, 20);
  }
  file["nodes"][1]["camera"] = 99;
  file["nodes"][2]["camera"] = "front";
  file["cameras"][2] = 7;
  EXPECT_THAT(cameras(file.dump()), ElementsAre("all"));
  file = scene();
  file["cameras"][0]["name"] = "red\x1b[31m";
  file["cameras"][1]["name"] = "two\nlines";
  EXPECT_THAT(cameras(file.dump()), ElementsAre("all", "door"));
}

}  // namespace
}  // namespace gatelight::tests
