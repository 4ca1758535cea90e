// Pictures with an open shutter whose light is known: wheels, jumps, cuts and bounces of a glowing square.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderer/render.h"
#include "tests/support/animated_file.h"

namespace gatelight::renderer {
namespace {

using scene::AnimatedFile;
using scene::json;

constexpr int kPixels = 32;

/// A square of the size 2 `half` around (x, 0, 0) on node 0, before an orthographic camera on node 1 that
/// shows two metres to each side.
AnimatedFile glowing_square(float x, float half) {
  AnimatedFile file;
  file.add("materials",
           {{"emissiveFactor", {1, 1, 1}},
            {"doubleSided", true},
            {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}}}});
  const json square = {{"attributes",
                        {{"POSITION", file.positions({x - half, -half, 0, x + half, -half, 0, x + half, half,
                                                      0, x - half, half, 0})}}},
                       {"indices", file.indices({0, 1, 2, 0, 2, 3})},
                       {"material", 0}};
  file.node({{"mesh", file.mesh(square)}});
  const int camera = file.add(
      "cameras",
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 2}, {"znear", 0}, {"zfar", 99}}}});
  file.node({{"camera", camera}, {"translation", {0, 0, 10}}});
  return file;
}

/// The light of a shutter that is open from 0 to 1 s.
class Light {
 public:
  explicit Light(AnimatedFile& file, float environment = 0.0f) {
    RenderOptions options;
    options.width = options.height = kPixels;
    options.spp = 256;
    options.filter = PixelFilter::box;
    options.environment.constant.setConstant(environment);
    picture_ = Renderer(file.load({.time = 0.5, .shutter = 1.0}), options).render();
  }

  /// The area in square metres that shines where `chosen` says so of (x, y), weighted by the time.
  double area(const std::function<bool(double, double)>& chosen = [](double, double) { return true; }) const {
    constexpr double kEdge = 4.0 / kPixels;
    double sum = 0.0;
    for (int row = 0; row < kPixels; ++row) {
      for (int column = 0; column < kPixels; ++column) {
        const double x = (column + 0.5) * kEdge - 2.0, y = 2.0 - (row + 0.5) * kEdge;
        const auto index = static_cast<std::size_t>(row * kPixels + column) * 3;
        if (chosen(x, y)) sum += kEdge * kEdge * static_cast<double>(picture_.layers[0].values[index]);
      }
    }
    return sum;
  }

 private:
  Picture picture_;
};

AnimatedFile::Keys turns(AnimatedFile& file, int count, const Vec3& axis = Vec3::UnitZ()) {
  AnimatedFile::Floats seconds, quaternions;
  for (int key = 0; key <= 4 * count; ++key) {
    seconds.push_back(static_cast<float>(key) / static_cast<float>(4 * count));
    const float half = 0.25f * kPi * static_cast<float>(key);
    const Vec3 v = std::sin(half) * axis;
    quaternions.insert(quaternions.end(), {v.x(), v.y(), v.z(), std::cos(half)});
  }
  return {file.seconds(seconds), file.quaternions(quaternions)};
}

TEST(ShutterPictures, AWheelAndWhatATurningCameraSeesAreRings) {
  for (const auto& [node, count] : {std::pair{0, 2}, {0, 4}, {1, 2}}) {
    SCOPED_TRACE(::testing::Message() << "node " << node << ", " << count << " turns");
    AnimatedFile file = glowing_square(1.2f, 0.24f);
    file.move(node, "rotation", turns(file, count));
    const Light light(file);
    // Chords are shorter than arcs: four turns lose 0.6 %, two thirds of twice the sagitta.
    EXPECT_NEAR(light.area(), 0.48 * 0.48, node == 0 ? 0.004 : 0.003);
    EXPECT_EQ(light.area([](double x, double y) { return std::hypot(x, y) < 0.96 - 0.1; }), 0.0);
    for (const double side : {-1.0, 1.0}) {
      EXPECT_NEAR(light.area([&](double x, double) { return x * side > 0.0; }), 0.5 * 0.48 * 0.48, 0.003);
      EXPECT_NEAR(light.area([&](double, double y) { return y * side > 0.0; }), 0.5 * 0.48 * 0.48, 0.004);
    }
  }
}

TEST(ShutterPictures, AJumpLeavesNothingBetween) {
  for (const float key : {0.5f, 0.3f}) {
    for (const int node : {0, 1}) {
      AnimatedFile file = glowing_square(0.0f, 0.2f);
      const float away = node == 0 ? 0.0f : 10.0f;
      file.move(node, "translation", {file.seconds({0, key}), file.vectors({-1.4f, 0, away, 1.4f, 0, away})},
                "STEP");
      const Light light(file);
      const double left = light.area([](double x, double) { return x < -1.0; });
      const double right = light.area([](double x, double) { return x > 1.0; });
      const double first = static_cast<double>(node == 0 ? key : 1.0f - key);
      EXPECT_NEAR(left, 0.16 * first, 2e-3) << "node " << node;
      EXPECT_NEAR(right, 0.16 * (1.0 - first), 2e-3) << "node " << node;
      EXPECT_EQ(light.area([](double x, double) { return std::abs(x) < 1.0; }), 0.0) << "node " << node;
    }
  }
}

TEST(ShutterPictures, ABounceReachesItsTurningPoint) {
  // Up to y = 1.4 at 0.55 s, and down again.
  AnimatedFile file = glowing_square(0.0f, 0.1f);
  file.move(0, "translation", {file.seconds({0, 0.55f, 1}), file.vectors({0, 0, 0, 0, 1.4f, 0, 0, 0, 0})});
  const Light light(file);
  // The square's middle is spread evenly over 0 to 1.4; above 1.25 are the uppermost 0.25 m, less its ramp.
  const double density = 0.2 / 1.4;
  EXPECT_NEAR(light.area([](double, double y) { return y > 1.25; }), 0.2 * density * (0.25 - 0.1), 4e-4);
  EXPECT_NEAR(light.area(), 0.04, 4e-4);
}

TEST(ShutterPictures, WhatIsHiddenInAPartIsThereInTheOther) {
  AnimatedFile file = glowing_square(0.0f, 0.5f);
  file.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
  file.move("/nodes/0/extensions/KHR_node_visibility/visible",
            {file.seconds({0, 0.25f}),
             file.accessor(std::vector<std::uint8_t>{1, 0}, scene::kUnsignedByte, "SCALAR", 2)},
            "STEP");
  EXPECT_NEAR(Light(file).area(), 0.25, 2e-3);
}

TEST(ShutterPictures, ALampThatIsOffInTheMiddleIsSampled) {
  const auto floor_light = [](float seconds) {
    AnimatedFile file = glowing_square(0.0f, 0.1f);
    file.root["nodes"][0]["translation"] = {2.6, 0, 1.5};
    file.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
    file.move("/nodes/0/extensions/KHR_node_visibility/visible",
              {file.seconds({0, seconds}),
               file.accessor(std::vector<std::uint8_t>{1, 0}, scene::kUnsignedByte, "SCALAR", 2)},
              "STEP");
    file.node({{"mesh", file.mesh(file.triangle())}, {"scale", {8, 8, 1}}, {"translation", {-2, -2, 0}}});
    return Light(file).area();
  };
  const double whole = floor_light(2.0f);
  EXPECT_GT(whole, 0.001);
  EXPECT_NEAR(floor_light(0.25f), 0.25 * whole, 0.005 * whole);
}

TEST(ShutterPictures, WhatTumblesInAFurnaceIsWhite) {
  // A ray that left the surface at another place than Embree's would meet it again.
  AnimatedFile file = glowing_square(1.2f, 0.5f);
  json& material = file.root["materials"][0];
  material["emissiveFactor"] = {0, 0, 0};
  material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 1};
  material["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
  file.root["nodes"][0]["translation"] = {0, 0, -40};
  const auto [times, values] = turns(file, 2, Vec3(0.6f, 0.8f, 0));
  const int hub = file.node({{"children", {0}}});
  file.root["scenes"][0]["nodes"] = {1, hub};
  file.move(0, "rotation", {times, values});
  file.move(hub, "translation", {file.seconds({0, 0.31f}), file.vectors({0, 0, 0, 0, 0.3f, 40})}, "STEP");
  const Light light(file, 1.0f);
  EXPECT_NEAR(light.area(), 16.0, 2e-3);
}

}  // namespace
}  // namespace gatelight::renderer
