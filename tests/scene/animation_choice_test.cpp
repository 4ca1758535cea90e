// Which animations of a file its scene shows, and which of their flaws matter.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using tests::expect_messages;
using Floats = std::vector<float>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Three animations. The first two move the triangle, the last one another node.
AnimatedFile three_animations() {
  AnimatedFile file = moving_triangle();
  file.node({{"camera", camera(file)}});
  file.animation("walk");
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 1, 0, 0})});
  file.animation("run");
  file.move(0, "translation", {file.seconds({0, 2}), file.vectors({0, 0, 0, 8, 0, 0})});
  file.animation("pan");
  file.move(1, "translation", {file.seconds({0, 4}), file.vectors({0, 0, 0, 0, 4, 0})});
  return file;
}

Vec3 place(const Scene& scene) {
  return scene.instances.at(0).transform.translation();
}

TEST(AnimationChoice, AllPlayTogetherButRivalsOfAnEarlierOne) {
  AnimatedFile file = three_animations();
  const Scene scene = file.at(1.0);
  EXPECT_EQ(place(scene), Vec3(1, 0, 0));
  EXPECT_EQ(Vec3(scene.cameras[0].transform.translation()), Vec3(0, 1, 0));
  expect_messages(scene.warnings, {{"run", "`animation`"}});
  ASSERT_EQ(scene.animations.size(), 3u);
  EXPECT_EQ(scene.animations[1].name, "run");
  EXPECT_EQ(scene.animations[2].seconds, 4.0);
}

TEST(AnimationChoice, ANameOrAnIndexChoosesOne) {
  AnimatedFile file = three_animations();
  for (const char* choice : {"run", "1"}) {
    const Scene scene = file.at(1.0, choice);
    EXPECT_EQ(place(scene), Vec3(4, 0, 0));
    EXPECT_EQ(Vec3(scene.cameras[0].transform.translation()), Vec3(0, 0, 0));
    EXPECT_TRUE(scene.warnings.empty());
  }
  file.root["animations"][2]["name"] = "0";
  EXPECT_EQ(place(file.at(1.0, "0")), Vec3(0, 0, 0)) << "a name wins over an index";
}

TEST(AnimationChoice, NoneShowsThePoseOfTheNodes) {
  const Scene scene = three_animations().at(1.0, "none");
  EXPECT_EQ(place(scene), Vec3(0, 0, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(AnimationChoice, AnUnknownNameIsRefusedWithTheKnownOnes) {
  AnimatedFile file = three_animations();
  file.expect_refused({"wolk", "walk", "run", "pan", "did you mean 'walk'"},
                      {.time = 0.0, .animation = "wolk"});
  file.expect_refused({"3", "walk"}, {.time = 0.0, .animation = "3"});
  file.expect_refused({"wolk"}, {.animation = "wolk"});
  AnimatedFile still = moving_triangle();
  still.expect_refused({"walk", "no animations"}, {.time = 0.0, .animation = "walk"});
}

TEST(AnimationChoice, ATimeWithoutAnimationsGivesAWarning) {
  EXPECT_TRUE(moving_triangle().at(1.0).warnings.empty());
}

TEST(AnimationChoice, ATimeThatIsNoNumberIsRefused) {
  for (const double time : {static_cast<double>(kNan), std::numeric_limits<double>::infinity()})
    tests::expect_refused_parts<BadOption>([&] { load_gltf("a.glb", {.time = time}); },
                                           {"time", fmt::format("{}", time)});
}

struct Flaw {
  const char* name;
  std::function<void(AnimatedFile& file)> make;
  tests::NameList message;  ///< empty: it loads, with a warning
  tests::NameList warning{};
};

void move_by(AnimatedFile& file, const Floats& times, const Floats& values,
             const char* interpolation = "LINEAR") {
  file.move(0, "translation", {file.seconds(times), file.vectors(values)}, interpolation);
}

Flaw moved(const char* name, const Floats& times, const Floats& values, const tests::NameList& message,
           const tests::NameList& warning = {}, const char* interpolation = "LINEAR") {
  return {name, [=](AnimatedFile& file) { move_by(file, times, values, interpolation); }, message, warning};
}

/// A value of a sound animation is another one; null: it is missing.
Flaw edited(const char* name, const std::string& pointer, const json& value, const tests::NameList& message,
            const tests::NameList& warning = {}) {
  const auto make = [=](AnimatedFile& file) {
    move_by(file, {0}, {0, 0, 0});
    const json::json_pointer place("/animations/1" + pointer);
    file.root[place] = value;
    if (value.is_null()) file.root[place.parent_pointer()].erase(place.back());
  };
  return {name, make, message, warning};
}

const Flaw kBrokenAnimations[] = {
    moved("FallingTimes", {0, 2, 1}, Floats(9), {"accessors", "2", "1"}),
    moved("NanTimes", {0, kNan}, Floats(6), {"accessors", "nan", "finite"}),
    moved("InfiniteTimes", {0, INFINITY}, Floats(6), {"accessors", "inf", "finite"}),
    moved("EqualTimes", {0, 1, 1}, Floats(9), {}, {"same time"}),
    moved("NoKeys", {}, {}, {}, {"animations[1].channels[0]", "no keys"}),
    moved("TooFewValues", {0, 1}, Floats(3), {"accessors", "1", "2", "animations[1].channels[0]"}),
    moved("TooManyValues", {0, 1}, Floats(9), {"accessors", "3", "2"}),
    moved("SplineWithoutTangents", {0, 1}, Floats(6), {"accessors", "2", "6"}, {}, "CUBICSPLINE"),
    moved("NanValues", {0, 1}, {0, 0, 0, 0, kNan, 0}, {"accessors", "finite"}),
    moved("UnknownInterpolation", {0}, {0, 0, 0}, {},
          {"animations[1].channels[0].sampler.interpolation", "BEZIER"}, "BEZIER"),
    edited("OtherType", "/channels/0/target/path", "rotation", {"accessors", "3", "4"}),
    edited("UnknownPath", "/channels/0/target/path", "colour", {},
           {"animations[1].channels[0]", "/nodes/0/colour"}),
    edited("WeightsWithoutTargets", "/channels/0/target/path", "weights", {},
           {"animations[1].channels[0]", "/nodes/0/weights"}),
    edited("MissingAccessor", "/samplers/0/input", 99, {"animations[1].channels[0].sampler.input", "99"}),
    edited("MissingOutput", "/samplers/0/output", nullptr,
           {"animations[1].channels[0].sampler.output", "missing"}),
    edited("MissingSampler", "/channels/0/sampler", 7, {"animations[1].channels[0].sampler", "7", "1"}),
    edited("NoSampler", "/channels/0/sampler", nullptr, {"animations[1].channels[0].sampler", "missing"}),
    edited("MissingNode", "/channels/0/target/node", 44,
           {"animations[1].channels[0].target.node", "44", "1"}),
    edited("NoTarget", "/channels/0/target/node", nullptr, {}, {"animations[1].channels[0]", "no target"}),
    edited("ChannelsThatAreNoList", "/channels", 3, {"animations[1].channels", "3"}),
    edited("AChannelThatIsNoObject", "/channels", json::array({3}), {"animations[1].channels[0]", "3"}),
    {"IntegerTimes",
     [](AnimatedFile& f) {
       f.move(0, "translation",
              {f.accessor(std::vector<std::uint8_t>{0}, kUnsignedByte, "SCALAR", 1), f.vectors({0, 0, 0})});
     },
     {"accessors", "5121", "5126"}},
    {"TimesOfThree",
     [](AnimatedFile& f) {
       f.move(0, "translation", {f.vectors({0, 0, 0}), f.vectors({0, 0, 0})});
     },
     {"accessors", "times", "1"}},
    {"TooManyBytes",
     [](AnimatedFile& f) {
       const int times = zeros(f, kFloat, "SCALAR", 2000000000);
       f.move(0, "translation", {times, times});
     },
     {"accessors", "2000000000", "1048576"}},
    {"TwoChannelsForOneValue",
     [](AnimatedFile& f) {
       move_by(f, {0}, {1, 0, 0});
       move_by(f, {0}, {2, 0, 0});
     },
     {},
     {"animations[1].channels[1]", "/nodes/0/translation"}},
};

/// The first animation is sound, the second one has the flaw.
TEST(BrokenAnimation, MattersOnlyWhereItIsChosen) {
  for (const Flaw& flaw : kBrokenAnimations) {
    SCOPED_TRACE(flaw.name);
    AnimatedFile file = moving_triangle();
    file.animation("sound");
    file.move(0, "scale", {file.seconds({0, 1}), file.vectors({1, 1, 1, 3, 3, 3})});
    file.animation("broken");
    flaw.make(file);
    EXPECT_TRUE(file.load().warnings.empty());
    const Scene scene = file.at(0.5, "sound");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.instances[0].transform.linear()(0, 0), 2.0f);
    if (flaw.message.empty()) {
      expect_messages(file.at(0.5, "1").warnings, {flaw.warning});
    } else {
      file.expect_refused(flaw.message, {.time = 0.5, .animation = "1"});
    }
  }
}

TEST(AnimationChoice, WeightsOfAnotherNumberThanTargetsAreRefused) {
  AnimatedFile file;
  json primitive = file.triangle();
  primitive["targets"] = {{{"POSITION", file.vectors(Floats(9))}}, {{"POSITION", file.vectors(Floats(9))}}};
  file.node({{"mesh", file.mesh(primitive)}});
  file.move(0, "weights", {file.seconds({0, 1, 2}), file.scalars(Floats(3))});
  file.expect_refused({"accessors", "3", "6"}, {.time = 0.0});
}

TEST(AnimationChoice, ChannelsOfWhatIsNotShownAreNotRead) {
  AnimatedFile file = moving_triangle();
  const int hidden = file.add("nodes", {{"name", "hidden"}});
  file.add("materials", json::object());
  file.move(hidden, "translation", {file.seconds({0, kNan}), 0});
  file.move("/materials/0/alphaCutoff", {99, 99});
  file.move(0, "translation", {file.seconds({0, 1}), file.vectors({0, 0, 0, 2, 0, 0})});
  EXPECT_EQ(file.place_at(0.5), Vec3(1, 0, 0));
}

TEST(AnimationChoice, BuffersOfOtherAnimationsNeedNotExist) {
  AnimatedFile file = three_animations();
  name_buffers(file, json::array({{{"byteLength", 24}, {"uri", "missing.bin"}}}));
  const int view = file.add("bufferViews", {{"buffer", 1}, {"byteLength", 24}});
  file.root["animations"][1]["samplers"][0]["output"] = accessor_of_view(file, view, kFloat, "VEC3", 2);
  EXPECT_EQ(place(file.at(1.0, "walk")), Vec3(1, 0, 0));
  file.expect_refused({"missing.bin"}, {.time = 1.0, .animation = "run"});
}

TEST(AnimationChoice, AnimationsThatAreNoListAreNone) {
  AnimatedFile file = moving_triangle();
  file.root["animations"] = "none";
  EXPECT_TRUE(file.load().animations.empty());
  EXPECT_TRUE(file.at(1.0).warnings.empty());
  file.root["animations"] = {
      3, {{"name", 5}, {"samplers", {{{"input", "x"}}, 4}}, {"channels", {{{"target", 3}}, 4}}}};
  EXPECT_EQ(file.load().animations.size(), 2u);
}

}  // namespace
}  // namespace gatelight::scene
