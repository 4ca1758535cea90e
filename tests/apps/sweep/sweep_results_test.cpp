// results.json and results.csv.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "apps/sweep/cell_record.h"
#include "apps/sweep/identity.h"
#include "apps/sweep/results.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/version.h"
#include "renderer/surface/embree.h"
#include "tests/apps/sweep/sweep_records.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using tests::TemporaryFolder;

ordered_json results_of(const std::vector<ordered_json>& cells) {
  return make_results({"x"}, {{.scene = {{"name", "a"}}, .cells = cells}});
}

TEST(SweepResults, TheTableEqualsTheJson) {
  const auto rows = read_csv(results_csv(results_of(
      {failed_record(cached("f", 4), "it, \"broke\""), done(cached("d")), done(traced("p"), false)})));
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
  const auto header = [](const std::vector<ordered_json>& cells) {
    return read_csv(results_csv(results_of(cells)))[0];
  };
  const ordered_json made = done(cached("d"));
  const std::vector<std::string> columns = header({made});
  EXPECT_THAT(std::vector<std::string>(columns.end() - 2, columns.end()),
              ElementsAre("axis_integrator", "axis_stack"));
  const std::vector<std::string> fixed(columns.begin(), columns.end() - 2);
  EXPECT_EQ(header({}), fixed);
  EXPECT_EQ(header({failed_record(cached("f", 4), "no")}), columns);
  EXPECT_EQ(header({done(traced("p"))}), std::vector<std::string>(columns.begin(), columns.end() - 1));
  // Each number of a record has its own column.
  std::set<std::string> expected;
  const ordered_json in_results = results_of({made})["cells"][0];
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
  const auto made = [](int threads, const std::string& isa, const std::string& by) {
    ordered_json cell = done(cached("d"));
    cell["options"]["threads"] = threads;
    cell["isa"] = isa;
    cell["version"] = by;
    return cell;
  };
  const ordered_json failed = failed_record(cached("f", 4), "no");
  const ordered_json all =
      results_of({failed, made(1, "scalar", "0.1"), made(7, "avx2", "0.2"), made(2, "avx2", "0.1")});
  EXPECT_EQ(all["schema"], 2);
  EXPECT_EQ(all["machine"], ordered_json({{"cpu", cpu_name()}, {"threads", 7}, {"isa", "avx2, scalar"}}));
  EXPECT_EQ(all["versions"]["gatelight"], version());
  EXPECT_EQ(all["versions"]["embree"], renderer::embree_version());
  EXPECT_EQ(all["versions"]["of_cells"], ordered_json({"0.1", "0.2"}));
  EXPECT_EQ(results_of({made(1, "scalar", "0.1")})["machine"]["isa"], "scalar");
  const ordered_json none = results_of({failed});
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

}  // namespace
}  // namespace gatelight::apps
