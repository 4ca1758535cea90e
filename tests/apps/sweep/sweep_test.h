#pragma once
// Small sweeps through the real program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::tests {

namespace fs = std::filesystem;
using nlohmann::json;

class SweepTest : public ::testing::Test {
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
  /// The results of a sweep that is done.
  json swept(const std::string& out, const Words& more = {}, const std::string& scene = cornell()) const {
    expect_done(run_gatelight_inside(words(out, more, scene)));
    return results(out);
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

/// When each file in the folders was written.
inline std::map<std::string, fs::file_time_type> times_of(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::file_time_type> found;
  for (const fs::path& folder : folders) {
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::directory_iterator(folder))
      found[entry.path().string()] = entry.last_write_time();
  }
  return found;
}

/// The results without the command and times, which differ between two runs.
inline json without_seconds(json results) {
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

inline std::size_t count(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace gatelight::tests
