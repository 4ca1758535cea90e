// Records of cells, results.json, results.csv and the advice that is read from them.

#include "apps/sweep/results.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "apps/sweep/advise.h"
#include "apps/sweep/cell_record.h"
#include "apps/sweep/identity.h"
#include "apps/sweep/request.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/version.h"
#include "renderer/image/image_write.h"
#include "renderer/settings/resolved_options.h"
#include "renderer/surface/embree.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

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
  s.cache.normal_input = true;
  s.cache.node_spacing = 0.1f;
  s.cache.backend = "cpu avx2";
  s.isa = "avx2";
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

TEST(SweepRecord, ContainsTheMeasurements) {
  const SweepPlan plan = small_plan();
  const CellPlace place{plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123", "ref"};
  const ordered_json r = done_record(place, statistics(), errors(), true, 2.5f);
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
  EXPECT_EQ(r["reference_id"], "ref");
  EXPECT_EQ(r["options"]["train-steps"], 8);
  EXPECT_EQ(r["options"]["seed"], 1);
  EXPECT_TRUE(r["errors"]["psnr"].is_null());
  EXPECT_TRUE(r["errors"]["hdr_flip"].is_null());
  EXPECT_EQ(r["errors"]["flip"], 0.1);
  EXPECT_EQ(r["errors"]["ssim"], 0.9);
  EXPECT_EQ(r["flip_percentiles"], ordered_json({{"q25", 0.2}, {"median", 0.3}, {"q75", 0.4}}));
  EXPECT_EQ(r["picture"], "pictures/0123.png");
}

TEST(SweepRecord, APlainIntegratorHasNoCache) {
  const SweepPlan plan = small_plan();
  const PlannedSeries& series = plan.scenes[0].series[1];
  ASSERT_EQ(series.label, "path");
  renderer::RenderStatistics s = statistics();
  const ordered_json r =
      done_record({plan.scenes[0], series, 1, 16, "0123", "ref"}, s, errors(), false, 2.5f);
  for (const char* key : {"encoding", "train_steps", "train_ms_per_step", "query_ms_per_2m", "memory_bytes",
                          "loss", "picture", "error_map"}) {
    EXPECT_TRUE(r.at(key).is_null()) << key;
  }
  EXPECT_TRUE(r["seconds"]["train"].is_null());
  EXPECT_EQ(r["seconds"]["total"], 0.25);
  EXPECT_EQ(r["spp"], 16);
}

TEST(SweepRecord, TimeOfTheDenoiserCountsAndTheEstimatedErrorIsKept) {
  const SweepPlan plan = small_plan();
  PlannedSeries series = plan.scenes[0].series[0];
  const CellPlace place{plan.scenes[0], series, 1, 8, "0123", "ref"};
  renderer::RenderStatistics s = statistics();
  EXPECT_TRUE(done_record(place, s, errors(), true, 2.5f)["seconds"]["denoise"].is_null());
  EXPECT_TRUE(done_record(place, s, errors(), true, 2.5f)["estimated_error"].is_null());
  series.settings.render.denoise.denoiser = renderer::DenoiserKind::oidn;
  s.denoise_seconds = 0.5;
  s.estimated_error = 0.125;
  const ordered_json r = done_record(place, s, errors(), true, 2.5f);
  EXPECT_EQ(r["seconds"]["denoise"], 0.5);
  EXPECT_EQ(r["seconds"]["total"], 4.25);
  EXPECT_EQ(r["estimated_error"], 0.125);
  EXPECT_EQ(r["options"]["denoiser"], "oidn");
}

TEST(SweepRecord, OfANamedRunKeepsWhatTheRunHasChosen) {
  SweepWords words;
  words.scenes = {"room.glb"};
  words.runs = {"finished: --preset standard"};
  words.no_plain = true;
  SweepPlan plan = make_plan(make_request(words));
  PlannedSeries& series = plan.scenes[0].series[0];
  const CellPlace place{plan.scenes[0], series, 1, 0, "0123", "ref"};
  EXPECT_TRUE(planned_record(place)["train_steps"].is_null());
  const ordered_json cached = done_record(place, statistics(), errors(), false, 2.5f);
  EXPECT_EQ(cached["run"], "finished");
  EXPECT_EQ(cached["train_steps"], 8);
  EXPECT_EQ(cached["options"]["train-steps"], 8);
  EXPECT_EQ(cached["spp"], 8);
  // Another scene gets paths.
  PlannedSeries chosen = series;
  renderer::use_integrator(chosen.settings.render, renderer::Integrator::path);
  const ordered_json traced =
      done_record({plan.scenes[0], chosen, 1, 0, "0123", "ref"}, statistics(), errors(), false, 2.5f);
  EXPECT_EQ(traced["integrator"], "path");
  EXPECT_TRUE(traced["encoding"].is_null());
  EXPECT_EQ(traced["spp"], 12);
  const TemporaryFolder folder;
  for (const ordered_json& record : {cached, traced}) {
    folder.write("cells/0123.json", record.dump());
    EXPECT_EQ(*read_done_record(folder.path().string(), place, false), record);
  }
}

TEST(SweepRecord, NamesTheMachineTheVersionAndTheChosenOptions) {
  const SweepPlan plan = small_plan();
  const CellPlace place{plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123", "ref"};
  const ordered_json r = done_record(place, statistics(), errors(), true, 2.5f);
  EXPECT_EQ(r["schema"], kSweepSchema);
  EXPECT_EQ(r["version"], version());
  EXPECT_EQ(r["cpu"], cpu_name());
  EXPECT_EQ(r["isa"], "avx2");
  EXPECT_EQ(r["backend"], "cpu avx2");
  EXPECT_EQ(planned_record(place)["options"]["normal-input"], "auto");
  EXPECT_EQ(r["options"]["normal-input"], "on");
  EXPECT_EQ(r["options"]["direction-input"], "off");
  EXPECT_EQ(r["options"]["albedo-input"], "off");
  EXPECT_EQ(r["options"]["node-spacing"], 0.1) << "not 0.10000000149";
  EXPECT_EQ(r["options"]["isa"], "avx2");
  EXPECT_EQ(r["options"]["filter-width"], 3.0);
  EXPECT_FALSE(r["options"].contains("ao-distance")) << "of other light";
  const ordered_json plain = done_record({plan.scenes[0], plan.scenes[0].series[1], 1, 16, "0123", "ref"},
                                         statistics(), errors(), true, 2.5f);
  EXPECT_FALSE(plain["options"].contains("normal-input"));
  EXPECT_TRUE(plain["backend"].is_null());
  const ordered_json failed = failed_record(place, "why");
  EXPECT_EQ(failed["version"], version());
  EXPECT_EQ(failed["cpu"], cpu_name());
  EXPECT_TRUE(failed["isa"].is_null());
  for (const auto& [key, value] : r.items()) EXPECT_TRUE(failed.contains(key)) << key;
}

TEST(SweepRecord, PixelsThatAreNotFiniteHaveNoFlip) {
  const SweepPlan plan = small_plan();
  CellErrors e = errors();
  e.flip.reset();
  const ordered_json r = done_record({plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123", "ref"},
                                     statistics(), e, true, 2.5f);
  EXPECT_TRUE(r["errors"]["flip"].is_null());
  EXPECT_TRUE(r["flip_percentiles"].is_null());
  EXPECT_TRUE(r["error_map"].is_null());
  EXPECT_FALSE(r["picture"].is_null());
}

TEST(SweepRecord, IsReadBackWithTheNamesOfTheCurrentPlan) {
  const TemporaryFolder folder;
  const std::string root = folder.path().string();
  const SweepPlan plan = small_plan();
  const CellPlace place{plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123", "ref"};
  const auto read = [&](bool pictures) { return read_done_record(root, place, pictures); };
  EXPECT_FALSE(read(false).has_value());
  ordered_json record = done_record(place, statistics(), errors(), true, 2.5f);
  record["series"] = "of another sweep";
  folder.write("cells/0123.json", record.dump());
  EXPECT_FALSE(read(true).has_value()) << "its picture is missing";
  EXPECT_TRUE((*read(false))["picture"].is_null());
  folder.write("pictures/0123.png", "");
  EXPECT_FALSE(read(true).has_value()) << "its picture is damaged";
  renderer::Picture picture{.width = 1, .height = 1};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = {1, 1, 1}}};
  renderer::write_image(picture, folder / "pictures/0123.png");
  const ordered_json found = *read(true);
  EXPECT_EQ(found["series"], plan.scenes[0].series[0].label);
  EXPECT_EQ(found["errors"], record["errors"]);
  EXPECT_EQ(found["seconds"], record["seconds"]);
  EXPECT_EQ(found["picture"], "pictures/0123.png");
  EXPECT_TRUE(found["error_map"].is_null());
  EXPECT_EQ(found["options"], record["options"]) << "the options that the render chose are kept";
  // Neither failed cells nor half files count.
  folder.write("cells/0123.json", failed_record(place, "why").dump());
  EXPECT_FALSE(read(false).has_value());
  folder.write("cells/0123.json", record.dump().substr(0, 200));
  EXPECT_FALSE(read(false).has_value());
  record["id"] = "another";
  folder.write("cells/0123.json", record.dump());
  EXPECT_FALSE(read(false).has_value());
}

TEST(SweepRecord, AnotherShapeOrSchemaIsIgnored) {
  const TemporaryFolder folder;
  const SweepPlan plan = small_plan();
  const CellPlace place{plan.scenes[0], plan.scenes[0].series[0], 1, 8, "0123", "ref"};
  const ordered_json whole = done_record(place, statistics(), errors(), false, 2.5f);
  const auto reads = [&](const ordered_json& json) {
    folder.write("cells/0123.json", json.dump());
    return read_done_record(folder.path().string(), place, false).has_value();
  };
  EXPECT_TRUE(reads(whole));
  for (const char* text : {"null", "[]", "1", "{}", R"({"status": null})", R"({"status": ["done"]})",
                           R"({"status": "done", "id": null})", R"({"status": "done", "id": "0123"})"}) {
    EXPECT_FALSE(reads(ordered_json::parse(text))) << text;
  }
  for (const char* key : {"schema", "version", "cpu", "isa", "errors", "seconds", "picture", "loss"}) {
    ordered_json without = whole;
    without.erase(key);
    EXPECT_FALSE(reads(without)) << key;
  }
  // Edited by hand.
  for (const char* text : {R"({"errors": {"flip": "zz"}})", R"({"errors": {"mse": [1]}})",
                           R"({"seconds": {"total": -5}})", R"({"seconds": {"render": "fast"}})",
                           R"({"loss": {}})", R"({"memory_bytes": 1})", R"({"estimated_error": "small"})",
                           R"({"picture": "../../secret.png"})", R"({"error_map": "cells/0123.json"})"}) {
    ordered_json edited = whole;
    edited.merge_patch(ordered_json::parse(text));
    EXPECT_FALSE(reads(edited)) << text;
  }
  ordered_json earlier = whole;
  earlier.erase("estimated_error");
  earlier["seconds"].erase("denoise");
  EXPECT_TRUE(reads(earlier)) << "of a version that neither denoised nor estimated";
  ordered_json negative = whole;
  negative["errors"]["psnr"] = -3.0;
  EXPECT_TRUE(reads(negative)) << "a very bad picture";
  const std::vector<std::pair<std::string, ordered_json>> changes = {{"schema", 1},
                                                                     {"version", 1},
                                                                     {"errors", nullptr},
                                                                     {"errors", {{"mse", 1}}},
                                                                     {"seconds", {{"total", nullptr}}}};
  for (const auto& [key, value] : changes) {
    ordered_json other = whole;
    other[key] = value;
    EXPECT_FALSE(reads(other)) << key << " " << value;
  }
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

TEST(SweepResults, TheTableEqualsTheJson) {
  const SweepPlan plan = small_plan();
  SceneResults scene;
  scene.scene = {{"name", "a"}};
  scene.cells.push_back(
      failed_record({plan.scenes[0], plan.scenes[0].series[0], 1, 4, "f", "ref"}, "it, \"broke\""));
  scene.cells.push_back(done_record({plan.scenes[0], plan.scenes[0].series[0], 1, 8, "d", "ref"},
                                    statistics(), errors(), true, 2.5f));
  scene.cells.push_back(done_record({plan.scenes[0], plan.scenes[0].series[1], 1, 8, "p", "ref"},
                                    statistics(), errors(), false, 2.5f));
  const ordered_json results = make_results({"gatelight", "sweep"}, {scene});
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

TEST(SweepResults, HaveTheSameColumnsWhateverTheirCells) {
  const SweepPlan plan = small_plan();
  const auto& series = plan.scenes[0].series;
  const auto header = [&](const std::vector<ordered_json>& cells) {
    return read_csv(results_csv(make_results({"x"}, {{.scene = {{"name", "a"}}, .cells = cells}})))[0];
  };
  const ordered_json made =
      done_record({plan.scenes[0], series[0], 1, 8, "d", "ref"}, statistics(), errors(), true, 2.5f);
  const std::vector<std::string> columns = header({made});
  EXPECT_THAT(std::vector<std::string>(columns.end() - 2, columns.end()),
              ElementsAre("axis_integrator", "axis_stack"));
  const std::vector<std::string> fixed(columns.begin(), columns.end() - 2);
  EXPECT_EQ(header({}), fixed);
  EXPECT_EQ(header({failed_record({plan.scenes[0], series[0], 1, 4, "f", "ref"}, "no")}), columns);
  EXPECT_EQ(header({done_record({plan.scenes[0], series[1], 1, 8, "p", "ref"}, statistics(), errors(), true,
                                2.5f)}),
            std::vector<std::string>(columns.begin(), columns.end() - 1));
  // Each number of a record has its own column.
  std::set<std::string> expected;
  const ordered_json in_results =
      make_results({"x"}, {{.scene = {{"name", "a"}}, .cells = {made}}})["cells"][0];
  for (const auto& [key, value] : in_results.items()) {
    if (key == "options" || key == "axes" || key == "schema") continue;
    if (!value.is_object()) expected.insert(key);
    if (!value.is_object()) continue;
    for (const auto& [part, number] : value.items()) expected.insert(key + "_" + part);
  }
  EXPECT_EQ(std::set<std::string>(fixed.begin(), fixed.end()), expected);
  EXPECT_EQ(fixed.size(), expected.size());
}

TEST(SweepResults, NameTheMachineAndTheVersionsOfTheirCells) {
  const SweepPlan plan = small_plan();
  const auto made = [&](int threads, const std::string& isa, const std::string& by) {
    ordered_json cell = done_record({plan.scenes[0], plan.scenes[0].series[0], 1, 8, "d", "ref"},
                                    statistics(), errors(), true, 2.5f);
    cell["options"]["threads"] = threads;
    cell["isa"] = isa;
    cell["version"] = by;
    return cell;
  };
  const auto results = [](const std::vector<ordered_json>& cells) {
    return make_results({"x"}, {{.scene = {{"name", "a"}}, .cells = cells}});
  };
  const ordered_json failed =
      failed_record({plan.scenes[0], plan.scenes[0].series[0], 1, 4, "f", "ref"}, "no");
  const ordered_json all =
      results({failed, made(1, "scalar", "0.1"), made(7, "avx2", "0.2"), made(2, "avx2", "0.1")});
  EXPECT_EQ(all["schema"], 2);
  EXPECT_EQ(all["machine"], ordered_json({{"cpu", cpu_name()}, {"threads", 7}, {"isa", "avx2, scalar"}}));
  EXPECT_EQ(all["versions"]["gatelight"], version());
  EXPECT_EQ(all["versions"]["embree"], renderer::embree_version());
  EXPECT_EQ(all["versions"]["of_cells"], ordered_json({"0.1", "0.2"}));
  EXPECT_EQ(results({made(1, "scalar", "0.1")})["machine"]["isa"], "scalar");
  const ordered_json none = results({failed});
  EXPECT_GT(none["machine"]["threads"], 0);
  EXPECT_NE(none["machine"]["isa"], "");
  EXPECT_EQ(none["versions"]["of_cells"], ordered_json::array());
}

TEST(SweepResults, AreReadBackOrRefused) {
  const TemporaryFolder folder;
  const std::string root = folder.path().string();
  const auto expect_refused = [&](tests::NameList names) {
    names.push_back(root);
    tests::expect_refusal<InputError>([&] { read_results(root); }, names);
  };
  expect_refused({});
  folder.write("results.json", "{\"a\": 1}");
  expect_refused({"results.json"});
  const std::string deep = std::string(500000, '[') + std::string(500000, ']');
  folder.write("results.json", R"({"schema": )" + deep + R"(, "cells": []})");
  expect_refused({"results.json"});
  folder.write("results.json", R"({"schema": 1, "cells": []})");
  expect_refused({"schema", "1", "2"});
  const ordered_json results = make_results({"x"}, {});
  folder.write("results.json", results.dump());
  EXPECT_EQ(read_results(root), results);
}

ordered_json cell(const std::string& series, int steps, double flip, double seconds, int seed = 1,
                  const std::string& scene = "room") {
  return {{"scene", scene},
          {"series", series},
          {"axes", ordered_json::object()},
          {"reference", "path"},
          {"reference_id", "of " + scene},
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
  EXPECT_EQ(advise({.max_error = 0.41, .max_seconds = {}}), "gate 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.31, .max_seconds = {}}), "hash 8 steps, 4 spp")
      << "one seed of gate has 0.4";
  EXPECT_EQ(advise({.max_error = 0.26, .max_seconds = {}}), "hash 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.15, .max_seconds = {}}), "gate 64 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 2.5}), "hash 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 100.0}), "gate 64 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.41, .max_seconds = 2.0}), "gate 8 steps, 4 spp");
  EXPECT_EQ(advise({.max_error = 0.01, .max_seconds = {}}), "gate 64 steps, 4 spp (not met)");
  EXPECT_EQ(advise({.max_error = 0.01, .max_seconds = 3.0}), "hash 8 steps, 4 spp (not met)");
  EXPECT_EQ(advise({.max_error = {}, .max_seconds = 0.5}), "gate 8 steps, 4 spp (not met)");
}

TEST(SweepAdvice, IsTextWithACommandForEachSceneAndKind) {
  ordered_json results = trade();
  results["cells"].push_back(cell("gate", 8, 0.5, 1.0, 1, "hall"));
  ordered_json bare = cell("bare", 8, 0.05, 1.0);
  bare["reference"] = "cache";
  bare["reference_id"] = "held";
  results["cells"].push_back(bare);
  const std::string text = give_advice(results, {.max_error = 0.26, .max_seconds = {}}).text;
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("room (path): hash, 8 steps, 4 spp: FLIP 0.2500, 2.5 s\n  gatelight render hash81"),
            HasSubstr("hall (path): none of 1 met it; the nearest is gate, 8 steps"),
            HasSubstr("room (cache): bare")));
  EXPECT_THAT(give_advice(results, {.max_error = 0.41, .max_seconds = {}}).text,
              AllOf(HasSubstr("FLIP of at most 0.41 with every seed"),
                    HasSubstr("FLIP 0.3000 (0.2000 to 0.4000 over 2 seeds), 2 s")));
  EXPECT_THAT(give_advice({{"cells", ordered_json::array()}}, {.max_error = 0.31, .max_seconds = {}}).unmet,
              HasSubstr("no cell"));
}

TEST(SweepAdvice, NamesScenesWhereNoCellMeetsTheLimits) {
  ordered_json results = trade();
  results["cells"].push_back(cell("gate", 8, 0.5, 1.0, 1, "hall"));
  const std::string unmet = give_advice(results, {.max_error = 0.26, .max_seconds = 9.5}).unmet;
  tests::expect_message(unmet, {"hall (path)", "0.26", "9.5"});
  EXPECT_THAT(unmet, Not(HasSubstr("room")));
  EXPECT_EQ(give_advice(results, {.max_error = 0.5, .max_seconds = {}}).unmet, "");
}

TEST(SweepAdvice, ErrorsAgainstDifferentReferencesAreNotCompared) {
  // Paths of two bounces are quicker, and near to a reference of two bounces.
  ordered_json results = {{"cells", ordered_json::array()}};
  for (const char* depth : {"2", "8"}) {
    for (const char* series : {"gate", "path"}) {
      ordered_json one =
          cell(fmt::format("{} max-depth {}", series, depth), 8, 0.04, depth[0] == '2' ? 1.0 : 3.0);
      one["axes"] = {{"integrator", series}, {"max-depth", depth}};
      one["reference_id"] = depth;
      results["cells"].push_back(one);
    }
  }
  EXPECT_THAT(give_advice(results, {.max_error = 0.05, .max_seconds = {}}).text,
              AllOf(HasSubstr("room (path, max-depth 2): gate max-depth 2"),
                    HasSubstr("room (path, max-depth 8): gate max-depth 8"), Not(HasSubstr("integrator"))));
  // No axis distinguishes them here.
  for (ordered_json& one : results["cells"]) one["axes"] = ordered_json::object();
  EXPECT_THAT(give_advice(results, {.max_error = 0.05, .max_seconds = {}}).text,
              AllOf(HasSubstr("room (path, reference 2): "), HasSubstr("room (path, reference 8): ")));
  // Nor are they pooled as seeds of one configuration.
  for (ordered_json& one : results["cells"]) one["series"] = "the same";
  EXPECT_EQ(configurations(results).size(), 2u);
}

}  // namespace
}  // namespace gatelight::apps
