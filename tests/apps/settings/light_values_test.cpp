// The values of --light-groups and --sky.

#include "apps/settings/light_flags.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "renderer/settings/resolved_options.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using namespace renderer;

using tests::expect_refused_parts;

constexpr const char* kName = "light-groups";

TEST(LightGroupOptions, AreReadAndWritten) {
  const std::string text = "key=Sun,Lamp*;sky-2_b=environment;odd=a=b, c";
  const std::vector<LightGroup> groups = {
      {"key", {"Sun", "Lamp*"}}, {"sky-2_b", {"environment"}}, {"odd", {"a=b", " c"}}};
  EXPECT_EQ(read_light_groups(kName, text), groups);
  EXPECT_EQ(text_of(groups), text);
  EXPECT_TRUE(read_light_groups(kName, "none").empty());
}

TEST(LightGroupOptions, BadOnesAreRefused) {
  const auto refuse = [](const std::string& text, const ErrorParts& wanted) {
    expect_refused_parts<BadOption>([&] { read_light_groups(kName, text); }, wanted);
  };
  refuse("", {kName, "", "", "NAME=LIGHT"});
  refuse("key", {kName, "key", "", "NAME=LIGHT"});
  refuse("key=Sun;", {kName, "", "", "NAME=LIGHT"});
  refuse("key=", {kName, "key=", "lacks", "NAME=LIGHT"});
  refuse("key=a,,b", {kName, "key=a,,b", "lacks", "NAME=LIGHT"});
  refuse("=Sun", {kName, "=Sun", "", "letters"});
  refuse("key light=Sun", {kName, "key light=Sun", "", "letters, digits"});
  refuse("key.R=Sun", {kName, "key.R=Sun", "", "letters"});
  refuse("key=Sun;key=Lamp", {kName, "key=Lamp", "twice", "once"});
  refuse("rest=Sun", {kName, "rest=Sun", "", "another"});
  std::string many = "a0=x";
  for (int i = 1; i < 16; ++i) many += ";a" + std::to_string(i) + "=x";
  EXPECT_EQ(read_light_groups(kName, many).size(), 16u);
  refuse(many + ";b=x", {kName, "", "17", "16"});
}

TEST(LightGroupOptions, AreOnlyForThePathTracer) {
  RenderOptions options;
  options.integrator = Integrator::nrc;
  check_light_groups(options);
  options.light_groups = {{"a", {"b"}}};
  expect_refused_parts<BadOption>([&] { check_light_groups(options); },
                                  {kName, "", "'nrc'", "`integrator` path"});
  options.integrator = Integrator::path;
  check_light_groups(options);
  options.light_groups = {{"a b", {"b"}}};
  expect_refused_parts<BadOption>([&] { check_light_groups(options); }, {kName, "a b=b", "", "letters"});
}

SkyOptions read(const std::string& text) {
  return read_sky("sky", text);
}

TEST(SkyOptionsText, EveryPartIsOptionalAndSpacesDoNotCount) {
  EXPECT_EQ(read("clear"), SkyOptions());
  const SkyOptions sky = read("turbidity=2.5, sun=90,-3.5 ,ground=0, size=1,intensity = 4");
  EXPECT_EQ(sky.turbidity, 2.5f);
  EXPECT_EQ(sky.sun_azimuth_degrees, 90.0f);
  EXPECT_EQ(sky.sun_elevation_degrees, -3.5f);
  EXPECT_EQ(sky.ground, 0.0f);
  EXPECT_EQ(sky.sun_size_degrees, 1.0f);
  EXPECT_EQ(sky.intensity, 4.0f);
  EXPECT_FALSE(sky.time);
  EXPECT_EQ(read("size=0").turbidity, SkyOptions().turbidity);
}

TEST(SkyOptionsText, ADateATimeAndAPlaceGiveTheSun) {
  const SkyOptions sky = read("date=2024-02-29, time=14:30, place=51.5,-0.12, zone=+5.5");
  ASSERT_TRUE(sky.time);
  EXPECT_EQ(*sky.time, (SunTime{2024, 2, 29, (14 * 60 + 30) * 60, 5.5, 51.5, -0.12}));
  EXPECT_EQ(read("date=2024-02-29,time=14:30:07,place=1,2").time->second_of_day, 52207);
  EXPECT_EQ(read("date=2024-02-29,time=14:30,place=1,2,zone=-3").time->zone_hours, -3.0);
}

TEST(SkyOptionsText, IsReadBack) {
  for (const char* text : {"clear", "sun=12.1,0.3,turbidity=1.7,intensity=1e-3",
                           "date=1999-12-31,time=23:59:58,place=-33.87,151.21,zone=11,size=0"}) {
    EXPECT_EQ(read(text_of(read(text))), read(text)) << text;
  }
}

TEST(SkyOptionsText, BadPartsAreNamed) {
  for (const auto& [text, wanted] : std::vector<std::pair<const char*, ErrorParts>>{
           {"turbidity=0.5", {"sky", "turbidity=0.5", "", "1 and at most 10"}},
           {"turbidity=11", {"sky", "turbidity=11", "", "10"}},
           {"turbidity", {"sky", "turbidity", "", "clear"}},
           {"", {"sky", "", "", "words"}},
           {"sun=90", {"sky", "sun=90", "", "two numbers"}},
           {"sun=1,2,3", {"sky", "sun=1,2,3", "", "two numbers"}},
           {"sun=90,91", {"sky", "sun=90,91", "", "90"}},
           {"sun=x,1", {"sky", "sun=x,1", "", "number"}},
           {"ground=1.5", {"sky", "ground=1.5", "", "1"}},
           {"size=0.01", {"sky", "size=0.01", "", "0.05"}},
           {"size=nan", {"sky", "size=nan", "", "number"}},
           {"intensity=-1", {"sky", "intensity=-1", "", "0"}},
           {"moon=1", {"sky", "moon", "", "turbidity|sun"}},
           {"ground=0.1,ground=0.2", {"sky", "", "ground= is given twice", "once"}},
           {"date=2026-02-29,time=1:00,place=1,2", {"sky", "date=2026-02-29", "", "date"}},
           {"date=26-02-01,time=1:00,place=1,2", {"sky", "date=26-02-01", "", "1900"}},
           {"date=2026-257-21,time=1:00,place=1,2", {"sky", "date=2026-257-21", "", "date"}},
           {"date=2026-06,time=1:00,place=1,2", {"sky", "date=2026-06", "", "date"}},
           {"date=2026-06-21,time=24:00,place=1,2", {"sky", "time=24:00", "", "time"}},
           {"date=2026-06-21,time=12,place=1,2", {"sky", "time=12", "", "time"}},
           {"date=2026-06-21,time=12:0x,place=1,2", {"sky", "time=12:0x", "", "time"}},
           {"date=2026-06-21,time=12:00,place=91,0", {"sky", "place=91,0", "", "90"}},
           {"date=2026-06-21,time=12:00,place=1,2,zone=15", {"sky", "zone=15", "", "14"}},
           {"date=2026-06-21,time=12:00", {"sky", "", "place=", "date="}},
           {"date=2026-06-21,place=1,2", {"sky", "", "time=", "date="}},
           {"time=12:00", {"sky", "", "date=", "time="}},
           {"zone=2", {"sky", "", "date=", "zone="}},
           {"sun=1,2,date=2026-06-21,time=12:00,place=1,2", {"sky", "", "sun= and date=", "one"}}})
    expect_refused_parts<BadOption>([&, text = text] { read(text); }, wanted);
}

}  // namespace
}  // namespace gatelight::apps
