// Records of cells, results.json, results.csv and the advice that is read from them.

#include "apps/sweep/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "apps/errors.h"
#include "apps/sweep/advise.h"
#include "apps/sweep/cell_record.h"
#include "apps/sweep/eta.h"
#include "apps/sweep/request.h"
#include "tests/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using tests::TemporaryFolder;

SweepPlan small_plan() {
  SweepWords words;
  words.scenes = {"a, \"b\".glb"};
  words.vary = {"stack=adaptive,1;adaptive"};
  words.train_steps = "4,8";
  return make_plan(make_request(words));
}

renderer::RenderStatistics statistics() {
  renderer::RenderStatistics s;
  s.render_seconds = 0.25;
  s.cache.scout_seconds = 0.5;
  s.cache.setup_seconds = 1.0;
  s.cache.train_seconds = 2.0;
  s.cache.train_step_seconds = 0.8;
  s.cache.steps = 8;
  s.cache.queries = 1000;
  s.cache.render_query_seconds = 0.001;
  s.cache.parameter_bytes = 123;
  s.cache.loss = 0.5;
  return s;
}

CellErrors errors() {
  CellErrors e;
  e.metrics.mse = 0.01;
  e.metrics.rel_mse = 0.02;
  e.metrics.psnr = std::numeric_limits<double>::infinity();
  e.rel_mse_clean = 0.015;
  e.ssim = 0.9;
  e.flip.emplace();
  e.flip->summary = {.mean = 0.1, .weighted_median = 0.3, .first_quartile = 0.2, .third_quartile = 0.4};
  return e;
}

TEST(SweepRecord, HoldsWhatWasMeasured) {
  const SweepPlan plan = small_plan();
  const CellPlace place{plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123"};
  const ordered_json r = done_record(place, statistics(), errors(), true);
  EXPECT_EQ(r["status"], "done");
  EXPECT_EQ(r["seconds"]["total"], 3.75);
  EXPECT_EQ(r["train_ms_per_step"], 250.0);
  EXPECT_EQ(r["train_step_ms"], 100.0);
  EXPECT_DOUBLE_EQ(r["query_ms_per_2m"], 2073.6);
  EXPECT_EQ(r["memory_bytes"]["parameters"], 123);
  EXPECT_EQ(r["axes"]["stack"], "adaptive,1");
  EXPECT_EQ(r["train_steps"], 8);
  EXPECT_EQ(r["spp"], 4);
  EXPECT_EQ(r["encoding"], "gate");
  EXPECT_EQ(r["reference"], "path");
  EXPECT_EQ(r["options"]["train-steps"], 8);
  EXPECT_EQ(r["options"]["seed"], 1);
  EXPECT_TRUE(r["errors"]["psnr"].is_null());
  EXPECT_TRUE(r["errors"]["hdr_flip"].is_null());
  EXPECT_EQ(r["errors"]["flip"], 0.1);
  EXPECT_EQ(r["errors"]["ssim"], 0.9);
  EXPECT_EQ(r["flip_percentiles"], ordered_json({{"q25", 0.2}, {"median", 0.3}, {"q75", 0.4}}));
  EXPECT_EQ(r["picture"], "pictures/0123.png");
}

TEST(SweepRecord, OfAPlainIntegratorHasNoCache) {
  const SweepPlan plan = small_plan();
  const PlannedSeries& series = plan.scenes[0].series[1];
  ASSERT_EQ(series.label, "path");
  renderer::RenderStatistics s = statistics();
  const ordered_json r = done_record({plan.scenes[0], series, 1, 16, "0123"}, s, errors(), false);
  for (const char* key : {"encoding", "train_steps", "train_ms_per_step", "query_ms_per_2m", "memory_bytes",
                          "loss", "picture", "error_map"}) {
    EXPECT_TRUE(r.at(key).is_null()) << key;
  }
  EXPECT_TRUE(r["seconds"]["train"].is_null());
  EXPECT_EQ(r["seconds"]["total"], 0.25);
  EXPECT_EQ(r["spp"], 16);
}

TEST(SweepRecord, PixelsThatAreNotFiniteHaveNoFlip) {
  const SweepPlan plan = small_plan();
  CellErrors e = errors();
  e.flip.reset();
  const ordered_json r =
      done_record({plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123"}, statistics(), e, true);
  EXPECT_TRUE(r["errors"]["flip"].is_null());
  EXPECT_TRUE(r["flip_percentiles"].is_null());
  EXPECT_TRUE(r["error_map"].is_null());
  EXPECT_FALSE(r["picture"].is_null());
}

TEST(SweepRecord, IsReadBackWithThePlansWordsOfToday) {
  const TemporaryFolder folder;
  const std::string root = folder.path().string();
  const SweepPlan plan = small_plan();
  const CellPlace place{plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123"};
  const auto read = [&](bool pictures) { return read_done_record(root, place, pictures); };
  EXPECT_FALSE(read(false).has_value());
  ordered_json record = done_record(place, statistics(), errors(), true);
  record["series"] = "of another sweep";
  folder.write("cells/0123.json", record.dump());
  EXPECT_FALSE(read(true).has_value()) << "its picture is missing";
  EXPECT_TRUE((*read(false))["picture"].is_null());
  folder.write("pictures/0123.png", "");
  const ordered_json found = *read(true);
  EXPECT_EQ(found["series"], plan.scenes[0].series[0].label);
  EXPECT_EQ(found["errors"], record["errors"]);
  EXPECT_EQ(found["seconds"], record["seconds"]);
  EXPECT_EQ(found["picture"], "pictures/0123.png");
  EXPECT_TRUE(found["error_map"].is_null());
  // Neither failed cells nor half files count.
  folder.write("cells/0123.json", failed_record(place, "why").dump());
  EXPECT_FALSE(read(false).has_value());
  folder.write("cells/0123.json", record.dump().substr(0, 200));
  EXPECT_FALSE(read(false).has_value());
  record["id"] = "another";
  folder.write("cells/0123.json", record.dump());
  EXPECT_FALSE(read(false).has_value());
}

/// Fields of lines, quotes as in RFC 4180.
std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && text[i + 1] == '"') {
      rows.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(SweepResults, TheTableSaysWhatTheJsonSays) {
  const SweepPlan plan = small_plan();
  SceneResults scene;
  scene.scene = {{"name", "a"}};
  scene.cells.push_back(
      failed_record({plan.scenes[0], plan.scenes[0].series[0], 1, 4, "f"}, "it, \"broke\""));
  scene.cells.push_back(
      done_record({plan.scenes[0], plan.scenes[0].series[0], 1, 8, "d"}, statistics(), errors(), true));
  scene.cells.push_back(
      done_record({plan.scenes[0], plan.scenes[0].series[1], 1, 8, "p"}, statistics(), errors(), false));
  const ordered_json results = make_results({"gatelight", "sweep"}, 2, {scene});
  EXPECT_EQ(results["schema"], 1);
  EXPECT_EQ(results["machine"]["threads"], 2);
  EXPECT_NE(results["machine"]["cpu"], "");
  const auto rows = read_csv(results_csv(results));
  ASSERT_EQ(rows.size(), 4u);
  std::map<std::string, std::vector<std::string>> columns;
  for (std::size_t c = 0; c < rows[0].size(); ++c) {
    for (std::size_t r = 1; r < rows.size(); ++r) {
      ASSERT_EQ(rows[r].size(), rows[0].size()) << r;
      columns[rows[0][c]].push_back(rows[r][c]);
    }
  }
  EXPECT_THAT(columns["status"], ElementsAre("failed", "done", "done"));
  EXPECT_THAT(columns["error"], ElementsAre("it, \"broke\"", "", ""));
  EXPECT_THAT(columns["axis_stack"], ElementsAre("adaptive,1", "adaptive,1", ""));
  EXPECT_THAT(columns["seconds_total"], ElementsAre("", "3.75", "0.25"));
  EXPECT_THAT(columns["errors_flip"], ElementsAre("", "0.1", "0.1"));
  EXPECT_THAT(columns["train_steps"], ElementsAre("4", "8", ""));
  EXPECT_THAT(columns["memory_bytes_parameters"], ElementsAre("", "123", ""));
  EXPECT_THAT(columns["command"][1], HasSubstr("'a, \"b\".glb'"));
  EXPECT_FALSE(columns.contains("seconds"));
  EXPECT_FALSE(columns.contains("errors"));
  EXPECT_FALSE(columns.contains("options_spp"));
}

TEST(SweepResults, AreReadBackOrRefused) {
  const TemporaryFolder folder;
  const std::string root = folder.path().string();
  const auto refusal = [&]() -> std::string {
    try {
      read_results(root);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal(), HasSubstr("there is no sweep"));
  folder.write("results.json", "{\"a\": 1}");
  EXPECT_THAT(refusal(), HasSubstr("no result"));
  folder.write("results.json", R"({"schema": 2, "cells": []})");
  EXPECT_THAT(refusal(), HasSubstr("schema is 2, expected 1"));
  const ordered_json results = make_results({"x"}, 1, {});
  folder.write("results.json", results.dump());
  EXPECT_EQ(read_results(root), results);
}

ordered_json cell(const std::string& series, int steps, double flip, double seconds, int seed = 1,
                  const std::string& scene = "room") {
  return {{"scene", scene},
          {"series", series},
          {"reference", "path"},
          {"train_steps", steps},
          {"spp", 4},
          {"seed", seed},
          {"status", "done"},
          {"seconds", {{"total", seconds}}},
          {"errors", {{"flip", flip}}},
          {"command", "gatelight render " + series + std::to_string(steps) + std::to_string(seed)}};
}

ordered_json trade() {
  ordered_json failed = cell("gate", 4, 0.0, 0.0);
  failed["status"] = "failed";
  ordered_json infinite = cell("gate", 2, 0.0, 0.0);
  infinite["errors"]["flip"] = nullptr;
  return {{"cells",
           {failed, infinite, cell("gate", 8, 0.4, 1.0), cell("gate", 8, 0.2, 3.0, 2),
            cell("gate", 64, 0.1, 4.0), cell("hash", 8, 0.25, 2.5), cell("hash", 64, 0.12, 9.0)}}};
}

TEST(SweepAdvice, MeansRunOverSeedsOfCellsThatAreDone) {
  const std::vector<Configuration> all = configurations(trade());
  ASSERT_EQ(all.size(), 4u);
  EXPECT_EQ(all[0].point, "8 steps, 4 spp");
  EXPECT_EQ(all[0].seeds, 2);
  EXPECT_DOUBLE_EQ(all[0].error, 0.3);
  EXPECT_DOUBLE_EQ(all[0].seconds, 2.0);
  EXPECT_EQ(all[0].smallest_error, 0.2);
  EXPECT_EQ(all[0].largest_error, 0.4);
  EXPECT_EQ(all[0].command, "gatelight render gate81");
}

TEST(SweepAdvice, NamesTheCheapestThatIsGoodEnough) {
  const std::vector<Configuration> all = configurations(trade());
  const auto advise = [&](AdviceLimits limits) {
    const Advice advice = choose(all, limits);
    return advice.best.series + " " + advice.best.point + (advice.met ? "" : " (not met)");
  };
  EXPECT_EQ(advise({.max_error = 0.31, .max_seconds = {}}), "gate 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.26, .max_seconds = {}}), "hash 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.15, .max_seconds = {}}), "gate 64 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 2.5}), "hash 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 100.0}), "gate 64 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.31, .max_seconds = 3.0}), "gate 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.01, .max_seconds = {}}), "gate 64 steps, 4 spp (not met)");
  EXPECT_EQ(advise({.max_error = 0.01, .max_seconds = 3.0}), "hash 8 steps, 4 spp (not met)");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 0.5}), "gate 8 steps, 4 spp (not met)");
}

TEST(SweepAdvice, IsTextWithACommandForEachSceneAndKind) {
  ordered_json results = trade();
  results["cells"].push_back(cell("gate", 8, 0.5, 1.0, 1, "hall"));
  ordered_json bare = cell("bare", 8, 0.05, 1.0);
  bare["reference"] = "cache";
  results["cells"].push_back(bare);
  const std::string text = advice_text(results, {.max_error = 0.26, .max_seconds = {}});
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("room (path): hash, 8 steps, 4 spp: FLIP 0.2500, 2.5 s\n  gatelight render hash81"),
            HasSubstr("hall (path): none of 1 met it; the nearest is gate, 8 steps"),
            HasSubstr("room (cache): bare")));
  EXPECT_THAT(advice_text(results, {.max_error = 0.31, .max_seconds = {}}),
              HasSubstr("FLIP 0.3000 (0.2000 to 0.4000 over 2 seeds), 2 s"));
  EXPECT_THAT(advice_text({{"cells", ordered_json::array()}}, {.max_error = 0.31, .max_seconds = {}}),
              HasSubstr("no cell"));
}

TEST(SweepClock, KnowsTheRestOnceEachKindWasSeen) {
  SweepClock clock;
  clock.plan_rest({{{"a nrc", "nrc"}, 10.0}, {{"a path", "path"}, 4.0}, {{"a nrc", "nrc"}, 20.0}});
  EXPECT_EQ(clock.count(), 3u);
  EXPECT_FALSE(clock.left(1.0, 0.0).has_value());
  EXPECT_FALSE(clock.left(1.0, 0.5).has_value());
  clock.finish(5.0);
  EXPECT_FALSE(clock.left(1.0, 0.0).has_value()) << "path was never done";
  EXPECT_DOUBLE_EQ(*clock.left(1.0, 0.25), 3.0 + 10.0) << "its own fraction is enough";
  clock.finish(2.0);
  EXPECT_DOUBLE_EQ(*clock.left(4.0, 0.0), 6.0);
  EXPECT_DOUBLE_EQ(*clock.left(40.0, 0.0), 0.0);
  clock.finish(10.0);
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 0.0);
  // Another scene is guessed from this one.
  clock.plan_rest({{{"b nrc", "nrc"}, 2.0}, {{"b nrc", "nrc"}, 4.0}});
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 3.0);
  // As soon as it has a task of its own, by that.
  clock.finish(10.0);
  EXPECT_DOUBLE_EQ(*clock.left(0.0, 0.0), 20.0);
}

}  // namespace
}  // namespace gatelight::apps
