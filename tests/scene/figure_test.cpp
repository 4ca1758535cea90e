// The posed figure of data/, against the bounds that its generator computes by itself.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "scene/gltf.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::scene {
namespace {

using nlohmann::json;

const std::string kFigure = GATELIGHT_DATA "/figure.glb";

json json_of_figure() {
  const std::string file = tests::read_file(kFigure);
  std::uint32_t length = 0;
  std::memcpy(&length, file.data() + 12, sizeof length);
  return json::parse(file.substr(20, length));
}

TEST(Figure, HasTheBoundsOfItsPose) {
  const Scene scene = load_gltf(kFigure);
  EXPECT_TRUE(scene.warnings.empty());
  const json expected = json_of_figure()["asset"]["extras"]["posed_bounds"];
  for (const std::string name : {"body", "face"}) {
    Box bounds;
    for (const Instance& instance : scene.instances) {
      if (instance.name != name) continue;
      for (const Vec3& p : scene.mesh_of(instance).positions) bounds.extend(instance.transform * p);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(bounds.min()[k], expected[name][0][k].get<float>(), 1e-4f) << name << k;
      EXPECT_NEAR(bounds.max()[k], expected[name][1][k].get<float>(), 1e-4f) << name << k;
    }
    if (name == "body") EXPECT_NEAR(bounds.min().y(), 0.0f, 1e-3f) << "it stands on the floor";
  }
}

TEST(Figure, HasAWalkOfEveryJoint) {
  const json root = json_of_figure();
  const json& walk = root["animations"][0];
  std::set<int> turned;
  int splines = 0;
  for (const json& channel : walk["channels"]) {
    const json& sampler = walk["samplers"][channel["sampler"].get<std::size_t>()];
    const json& times = root["accessors"][sampler["input"].get<std::size_t>()];
    EXPECT_EQ(times["min"][0], 0.0);
    EXPECT_EQ(times["max"][0], 1.0);
    if (channel["target"]["path"] == "rotation") turned.insert(channel["target"]["node"].get<int>());
    const bool spline = sampler["interpolation"] == "CUBICSPLINE";
    splines += spline ? 1 : 0;
    const json& values = root["accessors"][sampler["output"].get<std::size_t>()];
    EXPECT_EQ(values["count"].get<int>(), times["count"].get<int>() * (spline ? 3 : 1));
  }
  EXPECT_EQ(splines, 1);
  const json& joints = root["skins"][0]["joints"];
  EXPECT_EQ(turned, std::set<int>(joints.begin(), joints.end()));
}

}  // namespace
}  // namespace gatelight::scene
