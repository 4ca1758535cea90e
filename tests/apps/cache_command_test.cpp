// Small pictures with a cache through the real program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "renderer/image/image_read.h"
#include "tests/support/folder_test.h"
#include "tests/support/picture_files.h"
#include "tests/support/process.h"

namespace gatelight::tests {
namespace {

using nlohmann::json;
using renderer::Layer;
using renderer::Picture;
using renderer::read_image;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CacheCommand : public FolderTest {
 protected:
  Output render(Words flags, const std::string& scene = "cornell-box") const {
    const Words defaults = {"--size", "24x16", "--spp", "2", "--train-steps", "6", "--batch", "256"};
    for (std::size_t i = 0; i < defaults.size(); i += 2) {
      if (std::find(flags.begin(), flags.end(), defaults[i]) == flags.end()) {
        flags.insert(flags.end(), {defaults[i], defaults[i + 1]});
      }
    }
    flags.insert(flags.begin(), {"render", std::string(GATELIGHT_SOURCE_DIR) + "/data/" + scene + ".glb"});
    return run_gatelight(flags);
  }

  json statistics(Words flags, const std::string& scene = "cornell-box") const {
    flags.insert(flags.end(), {"-o", path("a.exr"), "--stats", "-"});
    const Output output = expect_done(render(flags, scene));
    return json::parse(output.out);
  }
};

/// Finite everywhere and not black.
void expect_picture(const std::string& path) {
  const Picture picture = read_image(path);
  double sum = 0.0;
  for (const float value : picture.layers[0].values) {
    ASSERT_TRUE(std::isfinite(value));
    ASSERT_GE(value, 0.0f);
    sum += value;
  }
  EXPECT_GT(sum, 0.0);
}

TEST_F(CacheCommand, ATrainingThatDivergesLeavesOldFilesAndExitsWith6) {
  const std::string old = folder.write("old.safetensors", "an older cache").string();
  const Output output = render({"--integrator", "nrc", "--learning-rate", "1000", "--train-steps", "32",
                                "--cache-out", old, "-o", path("a.exr")});
  expect_failure(output, 6, {"cornell-box.glb", "--learning-rate"});
  EXPECT_EQ(read_file(old), "an older cache");
  EXPECT_EQ(folder.count_files(), 1u);
}

TEST_F(CacheCommand, ALoadedCacheIsKeptWhereMoreTrainingDiverges) {
  const std::string good = path("good.safetensors");
  expect_done(render({"--integrator", "nrc", "--cache-out", good, "-o", path("a.exr")}));
  expect_done(render({"--integrator", "nrc", "--cache-in", good, "--train-steps", "0", "-o", path("b.exr")}));
  const Output output =
      render({"--integrator", "nrc", "--learning-rate", "1000", "--train-steps", "32", "--cache-in", good,
              "--cache-out", path("c.safetensors"), "-o", path("c.exr"), "--stats", path("c.json")});
  EXPECT_EQ(output.exit_code, 6) << output.err;
  expect_message(output.last_error_line(), {"cornell-box.glb", "--learning-rate"});
  EXPECT_EQ(beauty_of(path("c.exr")), beauty_of(path("b.exr")));
  EXPECT_TRUE(json::parse(read_file(path("c.json")))["train"].contains("diverged"));
  expect_done(render({"--integrator", "nrc", "--cache-in", path("c.safetensors"), "--train-steps", "0", "-o",
                      path("d.exr")}));
  EXPECT_EQ(beauty_of(path("d.exr")), beauty_of(path("b.exr")));
}

TEST_F(CacheCommand, BothIntegratorsRenderAndFillTheStatistics) {
  for (const char* integrator : {"nrc", "nao"}) {
    const json stats = statistics({"--integrator", integrator});
    expect_picture(path("a.exr"));
    EXPECT_EQ(stats["options"]["integrator"], integrator);
    EXPECT_EQ(stats["spp"], 2);
    EXPECT_EQ(stats["train"]["steps"], 6);
    EXPECT_EQ(stats["train"]["steps_wanted"], 6);
    EXPECT_EQ(stats["train"]["steps_chosen"], false);
    EXPECT_GE(stats["train"]["records"], 6 * 128);
    EXPECT_EQ(stats["train"]["rejected"], 0);
    for (const char* key : {"paths", "loss", "touched_nodes"}) EXPECT_GT(stats["train"][key], 0) << key;
    for (const char* part :
         {"scout", "setup", "train", "train_trace", "train_step", "render_trace", "render_query"}) {
      EXPECT_GT(stats["seconds"][part], 0.0) << part;
    }
    EXPECT_LE(stats["seconds"]["train_step"], stats["seconds"]["train"]);
    for (const char* key : {"parameters", "optimizer"}) EXPECT_GT(stats["memory_bytes"][key], 0) << key;
    for (const char* key : {"nodes", "node_spacing", "surfaces_stored", "queries"})
      EXPECT_GT(stats["cache"][key], 0) << key;
    EXPECT_LE(stats["cache"]["surfaces_stored"], stats["cache"]["surfaces_possible"]);
    EXPECT_FALSE(stats["cache"]["resolution_histogram"].empty());
    EXPECT_LE(stats["cache"]["queries"], 2 * 24 * 16 * 8);
    EXPECT_THAT(stats["cache"]["backend"].get<std::string>(), HasSubstr("cpu"));
  }
}

TEST_F(CacheCommand, TheNumberOfStepsIsChosenAndReported) {
  const json stats = statistics({"--integrator", "nao", "--train-steps", "auto", "--train-time", "0.02"});
  EXPECT_EQ(stats["train"]["steps_chosen"], true);
  EXPECT_GT(stats["train"]["steps_wanted"], 0);
}

TEST_F(CacheCommand, ThreadsDoNotChangeABit) {
  const std::vector<Words> runs = {
      {"--integrator", "nrc", "--self-training", "2", "--candidates", "4", "--aov", "all"},
      {"--integrator", "nao"},
      {"--integrator", "nrc", "--encoding", "hashgrid", "--query-at", "primary"}};
  for (const Words& run : runs) {
    std::vector<std::string> files;
    for (const char* threads : {"1", "3"}) {
      expect_done(render(words_of("--reproducible --quiet -o {} --threads {}", {path("a.exr"), threads}, run),
                         "material-grid"));
      files.push_back(read_file(path("a.exr")));
    }
    EXPECT_EQ(files[0], files[1]) << run[1];
  }
}

TEST_F(CacheCommand, EveryPresetRendersWithEitherEncoding) {
  for (const char* preset : {"bare", "preview", "standard", "final", "paper-nao", "paper-nrc"}) {
    for (const char* encoding : {"gate", "hashgrid"}) {
      const json stats = statistics({"--preset", preset, "--encoding", encoding});
      expect_picture(path("a.exr"));
      EXPECT_EQ(stats["options"]["preset"], preset);
      EXPECT_EQ(stats["options"]["encoding"], encoding);
      EXPECT_EQ(stats["width"], 24);
    }
  }
}

TEST_F(CacheCommand, ProgressGoesThroughThePhases) {
  const Output output = render({"--integrator", "nrc", "-o", path("a.png"), "--progress", "json"});
  std::istringstream lines(output.err);
  std::vector<std::string> phases;
  double last = 0.0;
  for (std::string line; std::getline(lines, line);) {
    const json object = json::parse(line);
    if (object["event"] != "progress") continue;
    const auto phase = object["phase"].get<std::string>();
    if (phases.empty() || phases.back() != phase) {
      phases.push_back(phase);
      last = 0.0;
    }
    EXPECT_GE(object["fraction"], last);
    last = object["fraction"];
    EXPECT_LE(object["fraction"], 1.0);
    EXPECT_GE(object.value("eta_seconds", 0.0), 0.0) << line;
  }
  EXPECT_THAT(phases, ElementsAre("scout", "train", "render"));
}

TEST_F(CacheCommand, AllLayersShowTheCache) {
  expect_done(render({"--integrator", "nrc", "--aov", "all", "-o", path("a.exr"), "--quiet"}));
  const Picture picture = read_image(path("a.exr"));
  for (const char* name : {"cache-answer", "cache-error", "training-count", "resolution", "nearest-node"}) {
    const Layer* layer = picture.find(name);
    ASSERT_NE(layer, nullptr) << name;
    EXPECT_TRUE(std::any_of(layer->values.begin(), layer->values.end(), [](float v) { return v > 0.0f; }))
        << name;
  }
}

TEST_F(CacheCommand, ASavedCacheOfAnotherSceneOrConfigurationIsCode2) {
  const std::string file = path("c.safetensors");
  expect_done(render({"--integrator", "nrc", "--quiet", "-o", path("a.exr"), "--cache-out", file}));
  const auto load = [&](const std::string& cache, const std::string& scene, const Words& more = {}) {
    return render(words_of("--integrator nrc --quiet -o {} --cache-in {}", {path("b.exr"), cache}, more),
                  scene);
  };
  expect_failure(load(file, "furnace"), 2, {file, "geometry"});
  expect_failure(load(file, "cornell-box", {"--hidden", "64"}), 2, {file, "hidden width", "64"});
  expect_failure(load(path("a.exr"), "cornell-box"), 2, {path("a.exr")});
  EXPECT_FALSE(std::filesystem::exists(path("b.exr")));
}

TEST_F(CacheCommand, InfoDescribesTheCacheOfARender) {
  const std::string scene = std::string(GATELIGHT_SOURCE_DIR) + "/data/material-grid.glb";
  const Words flags = words_of("--integrator nrc --size 24x16 --stack adaptive,1 --cache-roughness 0.25");
  const Output text = expect_done(run_gatelight(words_of("info {}", {scene}, flags)));
  EXPECT_THAT(text.out, HasSubstr("sides stored"));
  const json info = json::parse(run_gatelight(words_of("info {} --json -", {scene}, flags)).out);
  const json& cache = info["cache"];
  std::uint64_t nodes = 0, sides = 0;
  for (const json& instance : cache["instances"]) {
    nodes += instance["nodes"].get<std::uint64_t>();
    sides += instance["sides"].get<std::uint64_t>();
    EXPECT_EQ(instance["resolutions"].size(), instance["sides"] > 0 ? 2u : 0u) << instance;
  }
  EXPECT_EQ(cache["instances"].size(), info["instances"]);
  EXPECT_EQ(cache["nodes"], nodes);
  EXPECT_EQ(cache["surfaces_stored"], sides);
  EXPECT_EQ(cache["inputs"]["direction"], info["requirements"]["view_dependent"]);
  EXPECT_GE(cache["memory_bytes"]["parameters_without_scouting"], cache["memory_bytes"]["parameters"]);
  // The render has the cache that info described.
  const json stats = statistics(flags, "material-grid");
  EXPECT_EQ(stats["cache"]["nodes"], cache["nodes"]);
  EXPECT_EQ(stats["cache"]["surfaces_stored"], cache["surfaces_stored"]);
  for (const char* part : {"parameters", "optimizer", "layout"}) {
    EXPECT_EQ(stats["memory_bytes"][part], cache["memory_bytes"][part]) << part;
  }
}

}  // namespace
}  // namespace gatelight::tests
