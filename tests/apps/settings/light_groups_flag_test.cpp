// The value of --light-groups.

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

}  // namespace
}  // namespace gatelight::apps
