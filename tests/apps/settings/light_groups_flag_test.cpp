// The value of --light-groups.

#include "apps/settings/light_flags.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "renderer/settings/resolved_options.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

using namespace renderer;

using tests::expect_refusal;

TEST(LightGroupOptions, AreReadAndWritten) {
  const std::string text = "key=Sun,Lamp*;sky-2_b=environment;odd=a=b, c";
  const std::vector<LightGroup> groups = {
      {"key", {"Sun", "Lamp*"}}, {"sky-2_b", {"environment"}}, {"odd", {"a=b", " c"}}};
  EXPECT_EQ(read_light_groups(text), groups);
  EXPECT_EQ(text_of(groups), text);
  EXPECT_TRUE(read_light_groups("none").empty());
}

TEST(LightGroupOptions, BadOnesAreRefused) {
  const auto refuse = [](const std::string& text, const tests::NameList& names) {
    expect_refusal<BadOption>([&] { read_light_groups(text); }, names);
  };
  refuse("", {"`light-groups`", "''", "NAME=LIGHT"});
  refuse("key", {"`light-groups`", "'key'", "NAME=LIGHT"});
  refuse("key=Sun;", {"`light-groups`", "''", "NAME=LIGHT"});
  refuse("key=", {"`light-groups`", "'key='", "NAME=LIGHT"});
  refuse("key=a,,b", {"`light-groups`", "'key=a,,b'", "NAME=LIGHT"});
  refuse("=Sun", {"`light-groups`", "''", "letters"});
  refuse("key light=Sun", {"`light-groups`", "'key light'", "letters", "digits"});
  refuse("key.R=Sun", {"`light-groups`", "'key.R'", "letters"});
  refuse("key=Sun;key=Lamp", {"`light-groups`", "'key'", "twice"});
  refuse("rest=Sun", {"`light-groups`", "'rest'", "another"});
  std::string many = "a0=x";
  for (int i = 1; i < 16; ++i) many += ";a" + std::to_string(i) + "=x";
  EXPECT_EQ(read_light_groups(many).size(), 16u);
  refuse(many + ";b=x", {"`light-groups`", "17", "16"});
}

TEST(LightGroupOptions, AreOnlyForThePathTracer) {
  RenderOptions options;
  options.integrator = Integrator::nrc;
  check_light_groups(options);
  options.light_groups = {{"a", {"b"}}};
  expect_refusal<BadOption>([&] { check_light_groups(options); },
                            {"`light-groups`", "nrc", "`integrator` path"});
  options.integrator = Integrator::path;
  check_light_groups(options);
  options.light_groups = {{"a b", {"b"}}};
  expect_refusal<BadOption>([&] { check_light_groups(options); }, {"'a b'"});
}

}  // namespace
}  // namespace gatelight::apps
