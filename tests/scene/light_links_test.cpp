// Which objects lights light, and which cast shadows in their light: GATELIGHT_light_linking, and rules.

#include <gtest/gtest.h>

#include <string>

#include "scene/light_links.h"
#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;

/// Nodes "floor", "hero", "glass" with triangles, "panel" (node 3) with one of the emissive material "glow",
/// and lamps "key" (node 4) and "fill" (node 5).
AnimatedFile studio() {
  AnimatedFile file;
  json primitive = file.triangle(), emissive = primitive;
  primitive["material"] = file.add("materials", {{"name", "grey"}});
  emissive["material"] = file.add("materials", {{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}});
  const int mesh = file.mesh(primitive);
  for (const double z : {0.0, 1.0, 2.0})
    file.node({{"name", z == 0.0   ? "floor"
                        : z == 1.0 ? "hero"
                                   : "glass"},
               {"mesh", mesh},
               {"translation", {0, 0, z}}});
  file.node({{"name", "panel"}, {"mesh", file.mesh(emissive)}, {"translation", {0, 0, 3}}});
  set_lights(file, {{{"type", "point"}, {"name", "key"}}, {{"type", "point"}, {"name", "fill"}}});
  for (const int light : {0, 1}) file.node({{"extensions", light_of_node(light)}});
  return file;
}

json& link_of(AnimatedFile& file, int node) {
  return file.root["nodes"][static_cast<std::size_t>(node)]["extensions"]["GATELIGHT_light_linking"];
}

/// "floor hero", with "fog" where it is a member; "all" for no set.
std::string members(const Scene& scene, int number) {
  if (number < 0) return "all";
  const ObjectSet& set = scene.object_sets.at(static_cast<std::size_t>(number));
  EXPECT_EQ(set.instances.size(), scene.instances.size());
  std::string names;
  for (std::size_t i = 0; i < set.instances.size(); ++i) {
    if (set.instances[i]) names += (names.empty() ? "" : " ") + scene.instances[i].name;
  }
  return names + (set.fog ? " fog" : "");
}

std::string lit_by(const Scene& scene, const std::string& name) {
  for (const PunctualLight& light : scene.lights) {
    if (light.name == name) return members(scene, light.link.receivers);
  }
  return "no light";
}

const LightLink& link_of_panel(const Scene& scene) {
  return scene.instances.at(3).link;
}

TEST(LightLinksOfFiles, AreSetsOfTheNodesMeshes) {
  AnimatedFile file = studio();
  file.root["extensionsRequired"] = {"GATELIGHT_light_linking"};
  link_of(file, 4) = {{"receivers", {{"nodes", {1, 2}}}}, {"blockers", {{"nodes", {2}}, {"exclude", true}}}};
  link_of(file, 3) = {{"receivers", {{"nodes", {0}}, {"exclude", true}}}};
  file.root["scenes"][0]["extensions"]["GATELIGHT_light_linking"] = {{"blockers", {{"nodes", {0}}}}};
  const Scene scene = file.load();
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  EXPECT_EQ(lit_by(scene, "key"), "hero glass");
  EXPECT_EQ(members(scene, scene.lights[0].link.blockers), "floor hero panel fog");
  EXPECT_EQ(lit_by(scene, "fill"), "all");
  EXPECT_EQ(members(scene, link_of_panel(scene).receivers), "hero glass panel fog");
  EXPECT_EQ(members(scene, scene.environment_link.blockers), "floor");
  EXPECT_EQ(scene.environment_link.receivers, -1);
  EXPECT_EQ(scene.instances[0].link, LightLink());
  EXPECT_EQ(scene.object_sets.size(), 4u);
}

TEST(LightLinksOfFiles, ChildrenAreNotMeantButAllInstancesOfANodeAre) {
  AnimatedFile file = studio();
  file.root["nodes"][0]["children"] = {1};
  file.root["scenes"][0]["nodes"] = {0, 2, 3, 4, 5};
  const int places = file.vectors({0, 0, 0, 5, 0, 0});
  file.root["nodes"][2]["extensions"] = instancing({{"TRANSLATION", places}});
  link_of(file, 4) = {{"receivers", {{"nodes", {0, 2}}}}};
  EXPECT_EQ(lit_by(file.load(), "key"), "floor glass glass");
}

TEST(LightLinksOfFiles, EqualSetsAreOneAndTheSetOfAllIsNone) {
  AnimatedFile file = studio();
  link_of(file, 4) = {{"receivers", {{"nodes", {1, 2}}}}, {"blockers", {{"nodes", {2, 1, 1}}}}};
  link_of(file, 5) = {{"receivers", {{"nodes", json::array()}, {"exclude", true}}}};
  const Scene scene = file.load();
  EXPECT_EQ(scene.lights[0].link, (LightLink{0, 0}));
  EXPECT_EQ(scene.lights[1].link, LightLink());
  EXPECT_EQ(scene.object_sets.size(), 1u);
}

TEST(LightLinksOfFiles, ContradictionsGiveWarnings) {
  AnimatedFile file = studio();
  link_of(file, 4) = {{"receivers", {{"nodes", json::array()}}}};
  link_of(file, 1) = {{"receivers", {{"nodes", {0}}}}};
  const Scene scene = file.load();
  EXPECT_EQ(lit_by(scene, "key"), "");
  EXPECT_EQ(scene.instances[1].link, LightLink());
  expect_messages(scene.warnings, {{"nodes[4].extensions.GATELIGHT_light_linking.receivers", "no object"},
                                   {"nodes[1].extensions.GATELIGHT_light_linking", "no light"}});
}

TEST(LightLinksOfFiles, BadIndicesAreRefused) {
  AnimatedFile file = studio();
  link_of(file, 4) = {{"receivers", {{"nodes", {6}}}}};
  file.expect_refused({"GATELIGHT_light_linking.receivers.nodes[0]", "6", "nodes"});
  link_of(file, 4) = {{"blockers", {{"exclude", true}}}};
  file.expect_refused({"GATELIGHT_light_linking.blockers.nodes", "missing"});
}

LoadOptions with_rules(const std::vector<LightLinkRule>& rules) {
  return {.light_links = rules};
}

constexpr bool kReceivers = false, kBlockers = true, kOnly = false, kNot = true;

TEST(LightLinkRules, IncludeAndExcludeNodes) {
  const Scene scene = studio().load(with_rules({{"key", kReceivers, kOnly, {"hero", "fl*"}},
                                                {"fill", kReceivers, kNot, {"glass"}},
                                                {"fill", kBlockers, kNot, {"*"}},
                                                {"glow", kBlockers, kOnly, {"floor"}}}));
  EXPECT_EQ(lit_by(scene, "key"), "floor hero");
  EXPECT_EQ(scene.lights[0].link.blockers, -1);
  EXPECT_EQ(lit_by(scene, "fill"), "floor hero panel fog");
  EXPECT_EQ(members(scene, scene.lights[1].link.blockers), " fog");
  EXPECT_EQ(members(scene, link_of_panel(scene).blockers), "floor");
  EXPECT_EQ(link_of_panel(scene).receivers, -1);
  EXPECT_EQ(scene.instances[0].link, LightLink());
  EXPECT_EQ(scene.environment_link, LightLink());
}

TEST(LightLinkRules, OfOneLightAreCombined) {
  const Scene scene = studio().load(with_rules({{"*", kReceivers, kNot, {"hero"}},
                                                {"key", kReceivers, kOnly, {"hero", "glass"}},
                                                {"key", kReceivers, kOnly, {"floor"}},
                                                {"environment", kReceivers, kOnly, {"hero"}}}));
  EXPECT_EQ(lit_by(scene, "key"), "floor glass");
  EXPECT_EQ(lit_by(scene, "fill"), "floor glass panel fog");
  EXPECT_EQ(link_of_panel(scene).receivers, scene.lights[1].link.receivers) << "the same set";
  EXPECT_EQ(members(scene, scene.environment_link.receivers), "hero");
}

TEST(LightLinkRules, ReplaceTheFilesSetsOfTheSameKind) {
  AnimatedFile file = studio();
  link_of(file, 4) = {{"receivers", {{"nodes", {1}}}}, {"blockers", {{"nodes", {2}}}}};
  const Scene scene = file.load(with_rules({{"key", kReceivers, kOnly, {"floor"}}}));
  EXPECT_EQ(lit_by(scene, "key"), "floor");
  EXPECT_EQ(members(scene, scene.lights[0].link.blockers), "glass");
  EXPECT_EQ(scene.object_sets.size(), 2u) << "that of the file is dropped";
}

TEST(LightLinkRules, BadOnesAreRefused) {
  const auto refuse = [](const LightLinkRule& rule, const tests::NameList& names) {
    studio().expect_refused(names, with_rules({rule}));
  };
  refuse({"kei", kReceivers, kOnly, {"hero"}},
         {"light-links", "'kei'", "'fill'", "'glow'", "'environment'", "did you mean 'key'"});
  refuse({"grey", kReceivers, kOnly, {"hero"}}, {"'grey'", "'glow'"});
  refuse({"key", kReceivers, kOnly, {"hero", "heroes"}}, {"'heroes'", "'floor'", "did you mean 'hero'"});
  refuse({"key", kBlockers, kNot, {"x*"}}, {"'x*'", "'glass'"});
  refuse({"key", kReceivers, kNot, {"*"}}, {"'key'", "no object"});
  studio().expect_refused({"'key'", "no object"}, with_rules({{"key", kReceivers, kOnly, {"hero"}},
                                                              {"key", kReceivers, kNot, {"h*"}}}));
}

/// As many lamps, each of which lights, or is blocked by, another object.
AnimatedFile many_sets(int count, const char* what) {
  AnimatedFile file;
  const int mesh = file.mesh(file.triangle());
  json lights = json::array();
  for (int i = 0; i < count; ++i) {
    file.node({{"mesh", mesh}});
    lights.push_back({{"type", "point"}, {"name", "lamp"}});
  }
  set_lights(file, lights);
  for (int i = 0; i < count; ++i) {
    json extensions = light_of_node(i);
    extensions["GATELIGHT_light_linking"][what] = {{"nodes", {i}}};
    file.node({{"extensions", extensions}});
  }
  return file;
}

TEST(LightLinkRules, TooManySetsAreRefused) {
  EXPECT_EQ(many_sets(64, "receivers").load().object_sets.size(), 64u);
  many_sets(65, "receivers").expect_refused({"65", "receivers", "64"});
  EXPECT_EQ(many_sets(25, "blockers").load().object_sets.size(), 25u);
  many_sets(26, "blockers").expect_refused({"26", "blockers", "25"});
  many_sets(179, "blockers").expect_refused({"179", "178"});
}

TEST(LightLinkRules, AreTheSameAtAllTimes) {
  AnimatedFile file = studio();
  link_of(file, 5) = {{"receivers", {{"nodes", {1}}}}};
  file.move(4, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 4, 0, 0})});
  file.move("/materials/1/emissiveFactor", {file.seconds({0, 1}), file.vectors({0, 0, 0, 1, 1, 1})});
  const TemporaryFolder folder;
  SceneFile open(file.write(folder), {.time = 0.0,
                                      .light_links = {{"key", kReceivers, kOnly, {"floor"}},
                                                      {"glow", kReceivers, kOnly, {"hero"}}}});
  Scene scene = open.load();
  for (const double seconds : {0.0, 1.0, 0.5}) {
    open.show(scene, seconds);
    EXPECT_EQ(scene.lights[0].position.x(), 4.0f * static_cast<float>(seconds));
    EXPECT_EQ(lit_by(scene, "key"), "floor");
    EXPECT_EQ(lit_by(scene, "fill"), "hero");
    EXPECT_EQ(members(scene, link_of_panel(scene).receivers), "hero");
    EXPECT_EQ(scene.object_sets.size(), 2u);
  }
}

TEST(LightLinkRules, LightsThatAreOffHaveNames) {
  LoadOptions options = with_rules({{"glow", kReceivers, kOnly, {"hero"}}});
  options.lights = {{"glow", Color::Zero()}};
  EXPECT_EQ(members(studio().load(options), 0), "hero");
}

}  // namespace
}  // namespace gatelight::scene
