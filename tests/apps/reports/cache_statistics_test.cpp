#include "apps/reports/cache_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/reports/run_report.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using nlohmann::json;
using renderer::Integrator;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

renderer::CacheStatistics some_statistics() {
  renderer::CacheStatistics s;
  s.steps = 128;
  s.steps_wanted = 128;
  s.steps_chosen = true;
  s.records = 2097152;
  s.rejected = 3;
  s.unstored = 4;
  s.training_paths = 500000;
  s.touched_nodes = 999;
  s.loss = 0.25;
  s.scout_seconds = 0.5;
  s.setup_seconds = 0.75;
  s.train_seconds = 8.0;
  s.train_trace_seconds = 5.0;
  s.train_query_seconds = 1.0;
  s.train_step_seconds = 2.0;
  s.render_trace_seconds = 3.0;
  s.render_query_seconds = 1.5;
  s.queries = 36000;
  s.negative_answers = 7;
  s.unstored_hits = 2;
  s.nodes = 12345;
  s.surfaces_stored = 10;
  s.surfaces_possible = 40;
  s.node_spacing = 0.125f;
  s.target_scale = 2.0f;
  s.records_per_path = 3.5;
  s.resolution_histogram = {0, 6, 0, 0, 4};
  s.parameter_bytes = 1 << 20;
  s.optimizer_bytes = 2 << 20;
  s.layout_bytes = 3 << 20;
  s.backend = "cpu avx2";
  return s;
}

json statistics_of(Integrator integrator) {
  RenderSettings settings;
  settings.render.integrator = integrator;
  RunReport report;
  report.statistics.cache = some_statistics();
  return json::parse(stats_json(settings, report));
}

TEST(CacheStatistics, AreInTheStatisticsFile) {
  const json stats = statistics_of(Integrator::nrc);
  const json train = {{"steps", 128},       {"steps_wanted", 128}, {"steps_chosen", true},
                      {"records", 2097152}, {"loss", 0.25},        {"touched_nodes", 999},
                      {"rejected", 3},      {"unstored", 4},       {"paths", 500000}};
  EXPECT_EQ(stats["train"], train);
  const json cache = {{"backend", "cpu avx2"},
                      {"nodes", 12345},
                      {"surfaces_stored", 10},
                      {"surfaces_possible", 40},
                      {"resolution_histogram", {{"1", 6}, {"4", 4}}},
                      {"node_spacing", 0.125},
                      {"target_scale", 2.0},
                      {"records_per_path", 3.5},
                      {"queries", 36000},
                      {"negative_answers", 7},
                      {"unstored_hits", 2}};
  EXPECT_EQ(stats["cache"], cache);
  for (const auto& [key, value] :
       std::initializer_list<std::pair<const char*, double>>{{"scout", 0.5},
                                                             {"setup", 0.75},
                                                             {"train", 8.0},
                                                             {"train_trace", 5.0},
                                                             {"train_query", 1.0},
                                                             {"train_step", 2.0},
                                                             {"render_trace", 3.0},
                                                             {"render_query", 1.5}})
    EXPECT_EQ(stats["seconds"][key], value) << key;
  for (const auto& [key, value] :
       {std::pair{"parameters", 1 << 20}, {"optimizer", 2 << 20}, {"layout", 3 << 20}})
    EXPECT_EQ(stats["memory_bytes"][key], value) << key;
  EXPECT_EQ(stats["device"], "cpu");
}

TEST(CacheStatistics, TellTheDeviceThatWasChosen) {
  RenderSettings settings;
  settings.render.integrator = Integrator::nrc;
  settings.render.cache.choose_device = true;
  RunReport report;
  renderer::CacheStatistics& s = report.statistics.cache = some_statistics();
  EXPECT_EQ(json::parse(stats_json(settings, report))["options"]["device"], "auto");
  s.device = "vulkan:H100";
  s.trial = {"H100", 0.002, 0.0005};
  const json stats = json::parse(stats_json(settings, report));
  EXPECT_EQ(stats["device"], "vulkan:H100");
  EXPECT_EQ(stats["options"]["device"], "vulkan:H100");
  const json trial = {{"device", "H100"}, {"cpu_seconds", 0.002}, {"device_seconds", 0.0005}};
  EXPECT_EQ(stats["cache"]["trial"], trial);
  EXPECT_THAT(cache_summary(s, ""),
              ::testing::HasSubstr("vulkan:H100, chosen because a step takes 2.00 ms on the "
                                   "CPU and 0.50 ms on H100\n"));
}

TEST(CacheStatistics, AreAbsentWithoutACache) {
  const json stats = statistics_of(Integrator::path);
  for (const char* key : {"train", "cache"}) EXPECT_FALSE(stats.contains(key)) << key;
  for (const char* key : {"scout", "setup", "train", "train_step", "render_query"}) {
    EXPECT_FALSE(stats["seconds"].contains(key)) << key;
  }
  EXPECT_TRUE(stats["seconds"].contains("render_trace"));
  EXPECT_FALSE(stats["memory_bytes"].contains("parameters"));
}

renderer::CacheReport some_report() {
  renderer::CacheReport report;
  report.statistics = some_statistics();
  for (std::uint64_t i = 0; i < 20; ++i) {
    report.instances.push_back({.name = "instance " + std::to_string(i),
                                .triangles = 10,
                                .resolutions = {4, 1},
                                .sides = 1,
                                .nodes = 1000 * i});
  }
  report.statistics.direction_input = true;
  report.bytes_without_scouting = 8 << 20;
  return report;
}

TEST(CacheReport, TextShowsTheLargestInstancesAndSums) {
  renderer::RenderOptions options;
  options.integrator = Integrator::nrc;
  const std::string text = cache_report_text(some_report(), options);
  EXPECT_LT(text.find("instance 19\n"), text.find("instance 18\n"));
  EXPECT_THAT(text, AllOf(HasSubstr("4,1  instance 8\n"), Not(HasSubstr("instance 7\n"))));
  EXPECT_THAT(text, HasSubstr("      28 000           80      8             8 others\n"));
  EXPECT_THAT(text, HasSubstr("     190 000          200     20             all 20\n"));
}

TEST(CacheReport, JsonHoldsEveryInstance) {
  renderer::RenderOptions options;
  options.integrator = Integrator::nao;
  const json report = cache_report_json(some_report(), options);
  EXPECT_EQ(report["integrator"], "nao");
  EXPECT_EQ(report["encoding"], "gate");
  EXPECT_EQ(report["nodes"], 12345);
  EXPECT_EQ(report["inputs"], json({{"direction", true}, {"normal", false}, {"albedo", false}}));
  EXPECT_EQ(report["memory_bytes"]["parameters"], 1 << 20);
  EXPECT_EQ(report["memory_bytes"]["parameters_without_scouting"], 8 << 20);
  EXPECT_EQ(report["resolution_histogram"], json({{"1", 6}, {"4", 4}}));
  ASSERT_EQ(report["instances"].size(), 20u);
  const json third = {
      {"name", "instance 3"}, {"triangles", 10}, {"resolutions", {4, 1}}, {"sides", 1}, {"nodes", 3000}};
  EXPECT_EQ(report["instances"][3], third);
}

TEST(StopNotice, MentionsTrainingThatWasCutShort) {
  RenderSettings settings;
  settings.outputs = {"a.exr"};
  settings.render.integrator = Integrator::nrc;
  settings.render.cache.cache_out = "c.safetensors";
  RunReport report;
  report.signal = 2;
  report.statistics.spp = 1;
  report.statistics.cache = some_statistics();
  const auto expect_picture = [&] {
    tests::expect_message(stop_notice(settings, report), {"signal 2", "1", "64", "a.exr"});
    EXPECT_FALSE(tests::has_name(stop_notice(settings, report), "c.safetensors"));
  };
  expect_picture();  // training was complete
  report.statistics.cache.steps = 37;
  tests::expect_message(stop_notice(settings, report), {"signal 2", "37", "128", "c.safetensors"});
  settings.render.cache.train_seconds = report.statistics.cache.train_seconds;
  expect_picture();  // training had reached --train-time
  settings.render.cache.train_seconds = 0.0;
  settings.render.integrator = Integrator::path;
  expect_picture();  // there is no cache
}

}  // namespace
}  // namespace gatelight::apps
