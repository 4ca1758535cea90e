// Records of cells: written, and read back or ignored.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/sweep/cell_record.h"
#include "apps/sweep/identity.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/version.h"
#include "renderer/image/image_write.h"
#include "renderer/settings/resolved_options.h"
#include "tests/apps/sweep/sweep_records.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using tests::TemporaryFolder;

TEST(SweepRecord, ContainsTheMeasurements) {
  const ordered_json r = done(cached());
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
  ASSERT_EQ(traced().series.label, "path");
  const ordered_json r = done(traced(), false);
  for (const char* key : {"encoding", "train_steps", "train_ms_per_step", "query_ms_per_2m", "memory_bytes",
                          "loss", "picture", "error_map"}) {
    EXPECT_TRUE(r.at(key).is_null()) << key;
  }
  EXPECT_TRUE(r["seconds"]["train"].is_null());
  EXPECT_EQ(r["seconds"]["total"], 0.25);
  EXPECT_EQ(r["spp"], 16);
}

TEST(SweepRecord, TimeOfTheDenoiserCountsAndTheEstimatedErrorIsKept) {
  PlannedSeries series = cached().series;
  const CellPlace place{cached().scene, series, 1, 8, "0123", "ref"};
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
  SweepArguments words = arguments();
  words.runs = {"finished: --preset standard"};
  words.no_plain = true;
  SweepPlan plan = plan_from(words);
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
  const CellPlace place = cached();
  const ordered_json r = done(place);
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
  const ordered_json plain = done(traced());
  EXPECT_FALSE(plain["options"].contains("normal-input"));
  EXPECT_TRUE(plain["backend"].is_null());
  const ordered_json failed = failed_record(place, "why");
  EXPECT_EQ(failed["version"], version());
  EXPECT_EQ(failed["cpu"], cpu_name());
  EXPECT_TRUE(failed["isa"].is_null());
  for (const auto& [key, value] : r.items()) EXPECT_TRUE(failed.contains(key)) << key;
}

TEST(SweepRecord, PixelsThatAreNotFiniteHaveNoFlip) {
  CompareReport e = errors();
  e.flip.reset();
  const ordered_json r = done_record(cached(), statistics(), e, true, 2.5f);
  EXPECT_TRUE(r["errors"]["flip"].is_null());
  EXPECT_TRUE(r["flip_percentiles"].is_null());
  EXPECT_TRUE(r["error_map"].is_null());
  EXPECT_FALSE(r["picture"].is_null());
}

TEST(SweepRecord, IsReadBackWithTheNamesOfTheCurrentPlan) {
  const TemporaryFolder folder;
  const std::string root = folder.path().string();
  const CellPlace place = cached();
  const auto read = [&](bool pictures) { return read_done_record(root, place, pictures); };
  EXPECT_FALSE(read(false).has_value());
  ordered_json record = done(place);
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
  EXPECT_EQ(found["series"], place.series.label);
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
  const CellPlace place = cached();
  const ordered_json whole = done(place, false);
  const auto reads = [&](const ordered_json& json) {
    folder.write("cells/0123.json", json.dump());
    return read_done_record(folder.path().string(), place, false).has_value();
  };
  EXPECT_TRUE(reads(whole));
  for (const char* text : {"null", "[]", "1", "{}", R"({"status": null})", R"({"status": ["done"]})",
                           R"({"status": "done", "id": null})", R"({"status": "done", "id": "0123"})"}) {
    EXPECT_FALSE(reads(ordered_json::parse(text))) << text;
  }
  for (const char* key :
       {"schema", "version", "cpu", "isa", "errors", "seconds", "picture", "loss", "estimated_error"}) {
    ordered_json without = whole;
    without.erase(key);
    EXPECT_FALSE(reads(without)) << key;
  }
  // Edited by hand.
  for (const char* text : {R"({"errors": {"flip": "zz"}})", R"({"errors": {"mse": [1]}})",
                           R"({"seconds": {"total": -5}})", R"({"seconds": {"render": "fast"}})",
                           R"({"loss": {}})", R"({"memory_bytes": 1})", R"({"estimated_error": "small"})"}) {
    ordered_json edited = whole;
    edited.merge_patch(ordered_json::parse(text));
    EXPECT_FALSE(reads(edited)) << text;
  }
  ordered_json elsewhere = whole;
  elsewhere["picture"] = elsewhere["error_map"] = "cells/0123.json";
  EXPECT_TRUE(reads(elsewhere));
  const ordered_json shown = *read_done_record(folder.path().string(), place, false);
  EXPECT_TRUE(shown["picture"].is_null() && shown["error_map"].is_null());
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

}  // namespace
}  // namespace gatelight::apps
