#include "base/parallel/schedule.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/parallel/loops.h"
#include "base/parallel/team.h"

namespace gatelight {
namespace {

using nlohmann::json;

TEST(Schedule, HasTheOutermostLoopsWithTheirTasks) {
  std::string text;
  tbb::task_arena(1).execute([&] {
    for_each(3, [](std::size_t) {});  // before the recording
    const schedule::Recording recording;
    const schedule::Section section("all of it");
    for_each_range(25, 10, [](std::size_t, std::size_t) { for_each(7, [](std::size_t) {}); });
    Team::run([](Team& team) {
      team.beside(
          2, [](std::size_t) {}, [] { for_each(4, [](std::size_t) {}); });
    });
    text = recording.json(1);
  });
  const json record = json::parse(text);
  EXPECT_EQ(record["threads"], 1);
  ASSERT_EQ(record["events"].size(), 3u);
  const std::pair<const char*, std::size_t> expected[] = {{"loop", 3}, {"team", 4}, {"with", 2}};
  for (std::size_t i = 0; i < 3; ++i) {
    const json& event = record["events"][i];
    EXPECT_EQ(event[0], expected[i].first);
    EXPECT_NE(event[1].get<std::string>().find("schedule_test.cpp:"), std::string::npos);
    EXPECT_LE(event[2], event[4]);
    EXPECT_EQ(event[5].size(), expected[i].second);
  }
  // The lead, with its loop, ends before the tasks of a single thread begin.
  EXPECT_LE(record["events"][1][4], record["events"][2][3]);
  EXPECT_LE(record["events"][2][3], record["events"][2][4]);
  EXPECT_TRUE(record["stretches"].empty()) << "a section is recorded at its end";
}

TEST(Schedule, NothingIsKeptOfAnEarlierRecording) {
  {
    const schedule::Recording earlier;
    for_each(2, [](std::size_t) {});
  }
  const schedule::Recording recording;
  { const schedule::Section section("later"); }
  const json record = json::parse(recording.json(2));
  EXPECT_TRUE(record["events"].empty());
  ASSERT_EQ(record["stretches"].size(), 1u);
  EXPECT_EQ(record["stretches"][0][0], "later");
}

}  // namespace
}  // namespace gatelight
