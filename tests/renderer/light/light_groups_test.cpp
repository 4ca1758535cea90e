// Which group a light belongs to, and names that are refused.

#include "renderer/light/light_groups.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "scene/light_adjustments.h"
#include "tests/support/grouped_lights.h"
#include "tests/support/light_scenes.h"
#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using testing::LitScene;
using tests::expect_refused_parts;
using Names = std::vector<std::string>;

LitScene lit(const EnvironmentOptions& environment = {.constant = Color(1, 1, 1)}) {
  return LitScene(testing::lit_by_all(), LightSelection::tree, environment);
}

LightGroups groups_of(const LitScene& lit, const std::vector<LightGroup>& groups) {
  return {groups, lit.scene, lit.lights};
}

/// The numbers of the groups of bulb, torch, noon, the environment, and of the lamps' materials.
std::vector<std::size_t> numbers(const LitScene& lit, const LightGroups& groups) {
  const EmissiveTriangles& triangles = lit.lights.triangles();
  const auto first = static_cast<std::uint32_t>(triangles.size());
  std::vector<std::size_t> all;
  for (std::uint32_t light = 0; light < 4; ++light) all.push_back(groups.of_light(triangles, first + light));
  EXPECT_EQ(all.back(), groups.of_environment());
  for (const std::uint32_t triangle : {0u, first - 1}) {
    all.push_back(groups.of_light(triangles, triangle));
    EXPECT_EQ(all.back(), groups.of_instance(triangles[triangle].instance));
  }
  return all;
}

TEST(LightGroups, NamesStarsTheEnvironmentAndTheRest) {
  const LitScene all = lit();
  using Numbers = std::vector<std::size_t>;
  const LightGroups some = groups_of(all, {{"a", {"bulb", "pan*"}}, {"b", {"environment"}}});
  EXPECT_EQ(some.names(), (Names{"a", "b", "rest"}));
  EXPECT_EQ(numbers(all, some), (Numbers{0, 2, 2, 1, 0, 2}));
  const LightGroups none_left = groups_of(all, {{"sky", {"environment"}}, {"file", {"*"}}});
  EXPECT_EQ(none_left.names(), (Names{"sky", "file"}));
  EXPECT_EQ(numbers(all, none_left), (Numbers{1, 1, 1, 0, 1, 1}));
  EXPECT_TRUE(groups_of(all, {}).empty());
  // A '*' stands for lights of the file, not for the environment.
  EXPECT_EQ(groups_of(all, {{"a", {"*"}}}).names(), (Names{"a", "rest"}));
  EXPECT_EQ(groups_of(lit({}), {{"a", {"*"}}}).names(), (Names{"a"}));
}

TEST(LightGroups, LightsThatAreSwitchedOffKeepTheirNames) {
  scene::Scene scene = testing::lit_by_all();
  scene::adjust_lights(scene, {{"panel", Color::Zero()}, {"bulb", Color::Zero()}});
  const LitScene dark(std::move(scene));
  EXPECT_EQ(groups_of(dark, {{"a", {"panel", "bulb"}}}).names(), (Names{"a", "rest"}));
  EXPECT_EQ(groups_of(dark, {{"a", {"glow", "torch", "noon"}}}).names(), (Names{"a"}));
}

void refuse(const LitScene& of, const std::vector<LightGroup>& groups, const ErrorParts& wanted) {
  expect_refused_parts<BadOption>([&] { groups_of(of, groups); }, wanted);
}

TEST(LightGroups, UnknownNamesAreRefusedWithTheAvailableOnes) {
  const LitScene all = lit();
  refuse(all, {{"key", {"bulb", "tourch"}}},
         {"light-groups", "", "'tourch'", "'environment'", "did you mean 'torch'"});
  refuse(all, {{"key", {"moon*"}}}, {"light-groups", "", "'moon*'", "'noon'"});
  refuse(lit({}), {{"sky", {"environment"}}}, {"light-groups", "sky", "environment", "`sky`"});
  refuse(lit({}), {{"key", {"lamp"}}}, {"light-groups", "", "'lamp'", "'bulb'"});
}

TEST(LightGroups, ALightIsInOneGroup) {
  const LitScene all = lit();
  refuse(all, {{"a", {"bulb"}}, {"b", {"noon", "bu*"}}},
         {"light-groups", "bulb", "'a' and 'b'", "it in one"});
  refuse(all, {{"a", {"environment"}}, {"b", {"environment"}}},
         {"light-groups", "environment", "'a' and 'b'"});
  EXPECT_EQ(groups_of(all, {{"a", {"bulb", "bu*", "bulb"}}}).size(), 2u);
}

}  // namespace
}  // namespace gatelight::renderer
