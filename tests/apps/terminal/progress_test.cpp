#include "apps/terminal/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace gatelight::apps {
namespace {

using nlohmann::json;
using renderer::Phase;
using renderer::Progress;
using ::testing::HasSubstr;

/// The reporter's output for a picture of 1000 pixels.
std::string report(ProgressMode mode, const std::vector<Progress>& updates) {
  ::testing::internal::CaptureStderr();
  ProgressReporter reporter(mode, 1000.0);
  for (const Progress& update : updates) reporter.update(update);
  return ::testing::internal::GetCapturedStderr();
}

std::vector<json> report_json(const std::vector<Progress>& updates) {
  std::istringstream text(report(ProgressMode::json, updates));
  std::vector<json> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
  return lines;
}

const std::vector<Progress> kRun = {
    {.phase = Phase::scout, .fraction = 0.0, .seconds = 0.0},
    {.phase = Phase::train, .steps_done = 25, .steps = 100, .loss = 0.5, .fraction = 0.25, .seconds = 3.0},
    {.phase = Phase::train, .steps_done = 100, .steps = 100, .loss = 0.125, .fraction = 1.0, .seconds = 9.0},
    {.phase = Phase::render, .spp_done = 2, .spp = 8, .samples = 2.0, .fraction = 0.25, .seconds = 1.0},
};

TEST(Progress, EachPhaseHasItsMeasures) {
  const std::vector<json> lines = report_json(kRun);
  ASSERT_EQ(lines.size(), 4u);
  for (const json& line : lines) EXPECT_EQ(line["event"], "progress");
  EXPECT_EQ(lines[0]["phase"], "scout");
  EXPECT_FALSE(lines[0].contains("spp"));
  EXPECT_EQ(lines[1]["phase"], "train");
  EXPECT_EQ(lines[1]["steps_done"], 25);
  EXPECT_EQ(lines[1]["steps"], 100);
  EXPECT_EQ(lines[1]["loss"], 0.5);
  EXPECT_FALSE(lines[1].contains("spp"));
  EXPECT_FALSE(lines[1].contains("eta_seconds")) << "nothing is known yet";
  EXPECT_EQ(lines[2]["eta_seconds"], 0.0);
  EXPECT_EQ(lines[3]["phase"], "render");
  EXPECT_EQ(lines[3]["spp_done"], 2);
  EXPECT_FALSE(lines[3].contains("loss"));
  EXPECT_FALSE(report_json({{.phase = Phase::train, .fraction = 1.0}})[0].contains("loss")) << "no step";
  EXPECT_EQ(report(ProgressMode::none, kRun), "");
}

TEST(Progress, TimeLeftAndSpeedCountFromTheFirstUpdateOfThePhase) {
  ::testing::internal::CaptureStderr();
  {
    ProgressReporter reporter(ProgressMode::bar, 1000.0);
    for (const Progress& update : kRun) reporter.update(update);
    // The bar moves ten times a second.
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    reporter.update(
        {.phase = Phase::render, .spp_done = 4, .spp = 8, .samples = 4.0, .fraction = 0.5, .seconds = 2.0});
  }
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("4/8 spp  2.00 ksamples/s  ETA 0:02"))
      << "a quarter of 8000 samples in a second";
}

TEST(Progress, TimeOrErrorIsShownWhereItEndsThePicture) {
  const Progress timed = {
      .phase = Phase::render, .spp_done = 2, .spp = renderer::kUnlimitedSpp, .samples = 2.0};
  EXPECT_THAT(report(ProgressMode::bar, {timed}), HasSubstr("  2 spp  0 samples/s"));
  const Progress to_error = {.phase = Phase::render, .spp_done = 2, .spp = 8, .samples = 2.0, .error = 0.031};
  EXPECT_THAT(report(ProgressMode::bar, {to_error}), HasSubstr("2/8 spp  error 3.1 %  "));
  EXPECT_EQ(report_json({to_error})[0]["estimated_error"], 0.031);
  EXPECT_FALSE(report_json({timed})[0].contains("estimated_error"));
}

TEST(Progress, LinesAreRareWithinAPhase) {
  std::vector<Progress> updates;
  for (int i = 1; i < 100; ++i) {
    updates.push_back({.phase = i < 50 ? Phase::train : Phase::render, .spp = 1, .fraction = 0.01 * i});
  }
  EXPECT_EQ(report_json(updates).size(), 2u);
}

}  // namespace
}  // namespace gatelight::apps
