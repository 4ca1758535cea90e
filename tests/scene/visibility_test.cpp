// Which rays see objects, lamps and the environment: GATELIGHT_visibility, its animation, and rules.

#include <gtest/gtest.h>

#include <string>

#include "scene/visibility_rules.h"
#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"
#include "tests/support/words.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;
using tests::expect_refusal;

constexpr RayKinds without(RayKinds off) {
  return static_cast<RayKinds>(kAllRays & ~off);
}

json seen_by(const json& flags) {
  return {{"GATELIGHT_visibility", flags}};
}

/// Nodes "wall", "decoy" and "cut" with triangles, and lamps "key" and "fill".
AnimatedFile studio() {
  AnimatedFile file;
  const int mesh = file.mesh(file.triangle());
  for (const char* name : {"wall", "decoy", "cut"}) file.node({{"name", name}, {"mesh", mesh}});
  set_lights(file, {{{"type", "point"}, {"name", "key"}}, {{"type", "point"}, {"name", "fill"}}});
  for (const int light : {0, 1}) file.node({{"extensions", light_of_node(light)}});
  return file;
}

const Instance& instance_named(const Scene& scene, const std::string& name) {
  for (const Instance& instance : scene.instances) {
    if (instance.name == name) return instance;
  }
  throw std::runtime_error("no instance " + name);
}

RayKinds rays_of(const Scene& scene, const std::string& name) {
  return instance_named(scene, name).visibility.rays;
}

TEST(VisibilityOfFiles, EveryRaySeesEverythingByDefault) {
  AnimatedFile file = studio();
  file.root["nodes"][0]["extensions"] = seen_by(json::object());
  const Scene scene = file.load();
  for (const Instance& instance : scene.instances) EXPECT_EQ(instance.visibility, Visibility());
  EXPECT_EQ(scene.lights[0].rays, kAllRays);
  EXPECT_EQ(scene.environment_rays, kAllRays);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(VisibilityOfFiles, EachFlagIsOfTheNodeItselfNotOfItsChildren) {
  for (const auto& [name, kind] : kRayKindNames) {
    AnimatedFile file = studio();
    file.root["nodes"][0]["extensions"] = seen_by({{name, false}});
    file.root["nodes"][0]["children"] = {1};
    file.root["scenes"][0]["nodes"] = {0, 2};
    const Scene scene = file.load();
    EXPECT_EQ(rays_of(scene, "wall"), without(kind)) << name;
    EXPECT_EQ(rays_of(scene, "decoy"), kAllRays) << name;
  }
}

TEST(VisibilityOfFiles, HoldoutsShadowCatchersLampsAndTheEnvironment) {
  AnimatedFile file = studio();
  file.root["extensionsRequired"] = {"GATELIGHT_visibility"};
  file.root["nodes"][0]["extensions"] = seen_by({{"shadowCatcher", true}});
  file.root["nodes"][2]["extensions"] = seen_by({{"holdout", true}});
  file.root["nodes"][3]["extensions"].update(seen_by({{"glossy", false}}));
  file.root["scenes"][0]["extensions"] = seen_by({{"camera", false}, {"volume", false}});
  const Scene scene = file.load();
  EXPECT_EQ(instance_named(scene, "wall").visibility, (Visibility{kAllRays, false, true}));
  EXPECT_EQ(instance_named(scene, "cut").visibility, (Visibility{kAllRays, true, false}));
  EXPECT_EQ(scene.lights[0].rays, without(kGlossyRays));
  EXPECT_EQ(scene.lights[1].rays, kAllRays);
  EXPECT_EQ(scene.environment_rays, without(kCameraRays | kVolumeRays));
}

TEST(VisibilityOfFiles, WhatNothingSeesAndFlagsOfAWrongTypeGiveWarnings) {
  AnimatedFile file = studio();
  json nothing;
  for (const auto& [name, kind] : kRayKindNames) nothing[name] = false;
  file.root["nodes"][0]["extensions"] = seen_by({{"camera", 0}, {"shadow", false}});
  file.root["nodes"][1]["extensions"] = seen_by(nothing);
  file.root["nodes"][4]["extensions"].update(seen_by(nothing));
  file.root["scenes"][0]["extensions"] = seen_by(nothing);
  const Scene scene = file.load();
  EXPECT_EQ(rays_of(scene, "wall"), without(kShadowRays));
  EXPECT_EQ(rays_of(scene, "decoy"), 0);
  expect_messages(scene.warnings, {{"nodes[0].extensions.GATELIGHT_visibility.camera", "true or false"},
                                   {"nodes[1].extensions.GATELIGHT_visibility", "no ray"},
                                   {"nodes[4].extensions.GATELIGHT_visibility", "nothing"},
                                   {"scenes[0].extensions.GATELIGHT_visibility", "environment"}});
}

/// The wall is unseen by the camera, and the lamp "key" by diffuse rays, from 1 s to 2 s.
AnimatedFile blinking_studio() {
  AnimatedFile file = studio();
  file.root["nodes"][0]["extensions"] = seen_by({{"holdout", false}});
  file.root["nodes"][3]["extensions"].update(seen_by(json::object()));
  const int times = file.seconds({0, 1, 2});
  const auto blink = [&](const std::string& place, const std::vector<std::uint8_t>& values) {
    file.move("/nodes/" + place, {times, file.accessor(values, kUnsignedByte, "SCALAR", 3)}, "STEP");
  };
  blink("0/extensions/GATELIGHT_visibility/camera", {1, 0, 1});
  blink("0/extensions/GATELIGHT_visibility/holdout", {0, 1, 0});
  blink("3/extensions/GATELIGHT_visibility/diffuse", {1, 0, 1});
  return file;
}

TEST(VisibilityOfFiles, AnimationsChangeIt) {
  AnimatedFile file = blinking_studio();
  const TemporaryFolder folder;
  SceneFile open(file.write(folder), {.time = 0.5});
  Scene scene = open.load();
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  EXPECT_TRUE(scene.motion.instances && scene.motion.lights);
  EXPECT_TRUE(instance_named(scene, "wall").moves);
  EXPECT_FALSE(instance_named(scene, "wall").baked);
  EXPECT_FALSE(instance_named(scene, "cut").moves);
  for (const auto& [seconds, off] : {std::pair(1.5, true), {2.5, false}, {1.0, true}, {0.0, false}}) {
    open.show(scene, seconds);
    EXPECT_EQ(instance_named(scene, "wall").visibility,
              (Visibility{off ? without(kCameraRays) : kAllRays, off, false}))
        << seconds;
    EXPECT_EQ(scene.lights[0].rays, off ? without(kDiffuseRays) : kAllRays) << seconds;
  }
}

TEST(VisibilityOfFiles, InAnOpenShutterTheMiddleCounts) {
  AnimatedFile file = blinking_studio();
  for (const auto& [seconds, off] : {std::pair(0.9, false), {1.1, true}}) {
    const Scene scene = file.load({.time = seconds, .shutter = 0.5});
    EXPECT_EQ(rays_of(scene, "wall"), off ? without(kCameraRays) : kAllRays) << seconds;
    EXPECT_FALSE(scene.shutter.instances);
    EXPECT_TRUE(scene.shutter.clock.empty()) << "nothing jumps";
  }
}

TEST(VisibilityRules, LaterRulesOverrideEarlierOnesKindByKind) {
  AnimatedFile file = studio();
  file.root["nodes"][2]["extensions"] = seen_by({{"glossy", false}, {"shadow", false}, {"holdout", true}});
  const Scene scene = file.load({.visibility = {{.name = "*", .off = kCameraRays | kDiffuseRays},
                                                {.name = "de*", .only = kShadowRays | kVolumeRays},
                                                {.name = "wall", .on = kDiffuseRays, .holdout = true},
                                                {.name = "cut", .on = kGlossyRays, .holdout = false}}});
  EXPECT_EQ(instance_named(scene, "wall").visibility, (Visibility{without(kCameraRays), true, false}));
  EXPECT_EQ(rays_of(scene, "decoy"), kShadowRays | kVolumeRays);
  EXPECT_EQ(instance_named(scene, "cut").visibility,
            (Visibility{without(kCameraRays | kDiffuseRays | kShadowRays), false, false}));
  EXPECT_EQ(scene.lights[0].rays & kBounceRays, kBounceRays & ~kDiffuseRays) << "a star is of all names";
  EXPECT_EQ(scene.environment_rays, kAllRays) << "but not of the environment";
}

TEST(VisibilityRules, OnlyIsBeforeOnAndOffOfItsRule) {
  const Scene scene = studio().load(
      {.visibility = {{.name = "wall", .on = kShadowRays, .off = kGlossyRays, .only = kBounceRays}}});
  EXPECT_EQ(rays_of(scene, "wall"), without(kCameraRays | kGlossyRays));
}

TEST(VisibilityRules, LampsAndTheEnvironmentHaveNames) {
  const Scene scene = studio().load({.visibility = {{.name = "key", .only = kGlossyRays},
                                                    {.name = "environment", .off = kCameraRays},
                                                    {.name = "fill", .off = kVolumeRays}}});
  EXPECT_EQ(scene.lights[0].rays, kGlossyRays);
  EXPECT_EQ(scene.lights[1].rays, without(kVolumeRays));
  EXPECT_EQ(scene.environment_rays, without(kCameraRays));
  for (const Instance& instance : scene.instances) EXPECT_EQ(instance.visibility, Visibility());
}

TEST(VisibilityRules, KindsThatMeetNoLampLeaveLampsAlone) {
  const Scene scene = studio().load({.visibility = {{.name = "*", .only = kCameraRays | kShadowRays}}});
  EXPECT_EQ(rays_of(scene, "wall"), kCameraRays | kShadowRays);
  EXPECT_EQ(scene.lights[0].rays, kAllRays);
}

TEST(VisibilityRules, BadOnesAreRefused) {
  const auto refuse = [](const std::vector<VisibilityRule>& rules, const tests::NameList& names) {
    studio().expect_refused(names, {.visibility = rules});
  };
  refuse({{.name = "wal", .off = kCameraRays}},
         {"visibility", "'wal'", "'cut'", "'decoy'", "'key'", "'environment'", "did you mean 'wall'"});
  refuse({{.name = "x*", .holdout = true}}, {"'x*'"});
  refuse({{.name = "key", .off = kCameraRays}}, {"'key'", "light", "diffuse"});
  refuse({{.name = "key", .holdout = true}}, {"'key'", "light"});
  refuse({{.name = "wall", .off = kAllRays}}, {"'wall'", "no ray"});
  refuse({{.name = "wall", .off = kBounceRays}, {.name = "w*", .off = kCameraRays | kShadowRays}},
         {"'wall'", "no ray"});
  refuse({{.name = "key", .off = kBounceRays}}, {"'key'", "nothing", "diffuse"});
  refuse({{.name = "environment", .only = kShadowRays}}, {"environment", "no ray"});
}

TEST(VisibilityRules, WhatTheyTakeIsJudgedTogetherWithTheFile) {
  AnimatedFile file = studio();
  file.root["nodes"][0]["extensions"] = seen_by({{"camera", false}});
  const RayKinds rest = without(kCameraRays);
  file.expect_refused({"'wall'", "no ray"}, {.visibility = {{.name = "wall", .off = rest}}});
  EXPECT_EQ(rays_of(file.load({.visibility = {{.name = "decoy", .off = rest}}}), "decoy"), kCameraRays);
  // An animation may hide it for a while.
  AnimatedFile blinking = blinking_studio();
  blinking.root["nodes"][0]["extensions"] = seen_by({{"camera", false}});
  const LoadOptions options{.time = 1.5, .visibility = {{.name = "wall", .off = rest}}};
  EXPECT_EQ(rays_of(blinking.load(options), "wall"), 0);
}

TEST(VisibilityRules, StayInForceAtAllTimes) {
  AnimatedFile file = blinking_studio();
  const TemporaryFolder folder;
  const auto path = file.write(folder);
  LoadOptions options{.time = 0.0,
                      .visibility = {{.name = "wall", .off = kShadowRays, .holdout = true},
                                     {.name = "key", .off = kVolumeRays},
                                     {.name = "cut", .only = kCameraRays}}};
  SceneFile open(path, options);
  Scene scene = open.load();
  for (const double seconds : {0.5, 1.5, 1.6, 0.0}) {
    open.show(scene, seconds);
    const RayKinds off = seconds > 1.0 ? kCameraRays : 0;
    EXPECT_EQ(instance_named(scene, "wall").visibility,
              (Visibility{without(kShadowRays | off), true, false}));
    EXPECT_EQ(rays_of(scene, "cut"), kCameraRays);
    EXPECT_EQ(scene.lights[0].rays, without(static_cast<RayKinds>(kVolumeRays | (off ? kDiffuseRays : 0))));
    options.time = seconds;
    const Scene fresh = load_gltf(path, options);
    for (std::size_t i = 0; i < fresh.instances.size(); ++i)
      EXPECT_EQ(fresh.instances[i].visibility, scene.instances[i].visibility) << i;
    EXPECT_EQ(fresh.lights[0].rays, scene.lights[0].rays);
  }
}

TEST(VisibilityRules, EmittersInThePlaceOfWhatOtherRaysSeeBothStay) {
  const auto triangles = [](const std::vector<VisibilityRule>& rules) {
    AnimatedFile file;
    json plain = file.triangle(), lamp = file.triangle();
    plain["material"] = file.add("materials", {{"doubleSided", true}});
    lamp["material"] = file.add("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
    file.node({{"name", "plain"}, {"mesh", file.mesh(plain)}});
    file.node({{"name", "lamp"}, {"mesh", file.mesh(lamp)}});
    return count_triangles(file.load({.visibility = rules}));
  };
  EXPECT_EQ(triangles({}), 1u);
  EXPECT_EQ(triangles({{.name = "plain", .only = kCameraRays}, {.name = "lamp", .off = kCameraRays}}), 2u);
}

}  // namespace
}  // namespace gatelight::scene
