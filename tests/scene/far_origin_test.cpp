// A scene far from the origin has the shape of the same scene near it: all that a file places.

#include <gtest/gtest.h>

#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using Place = Eigen::Vector3d;

/// An instance, a skin, copies of a skin, a morph target, a camera and a light around a place. In a second
/// the joint turns and the target grows.
AnimatedFile scene_around(const Place& place) {
  AnimatedFile file;
  set_lights(file, {{{"type", "point"}}});
  json morphed = file.triangle();
  morphed["targets"] = {{{"POSITION", file.vectors({0, 0, 0.125f, 0, 0, 0.25f, 0, 0, 0.5f})}}};
  const int copies = file.vectors({0, 2, 0, 0, 3, 0.1f});
  const int joint = file.add("nodes", {{"translation", {0.3, 0.2, 0.1}}});
  file.add("skins", {{"joints", {joint}}});
  json children = {joint};
  const auto child = [&](const json& node) { return children.emplace_back(file.add("nodes", node)); };
  child({{"mesh", file.mesh(file.triangle())}, {"translation", {-1.1, 0.7, 0}}});
  child({{"mesh", file.mesh(triangle_of_joint(file))}, {"skin", 0}});
  child({{"mesh", file.mesh(triangle_of_joint(file))},
         {"skin", 0},
         {"extensions", instancing({{"TRANSLATION", copies}})}});
  const int growing = child({{"mesh", file.mesh(morphed)}, {"translation", {0, 0, -1.3}}});
  child({{"camera", camera(file)}, {"translation", {0.01, 0.02, 5}}});
  child({{"extensions", light_of_node(0)}, {"translation", {0.6, 3.3, 0}}});
  file.node({{"children", children}, {"translation", {place.x(), place.y(), place.z()}}});
  file.move(joint, "rotation", {file.seconds({0, 1}), file.quaternions({0, 0, 0, 1, 0, 0, 1, 0})});
  file.move(growing, "weights", {file.seconds({0, 1}), file.scalars({0, 1})});
  return file;
}

/// All vertices, cameras and lights, as seen from the place.
std::vector<Place> points_from(const Scene& scene, const Place& place) {
  std::vector<Place> points;
  const Place origin = scene.origin.cast<double>() - place;
  for (const Instance& instance : scene.instances) {
    for (const Vec3& p : scene.mesh_of(instance).positions)
      points.push_back(Vec3(instance.transform * p).cast<double>() + origin);
  }
  points.push_back(scene.cameras.at(0).transform.translation().cast<double>() + origin);
  points.push_back(scene.lights.at(0).position.cast<double>() + origin);
  return points;
}

TEST(FarOrigin, MovesNothingInTheScene) {
  for (const bool baked : {false, true}) {
    for (const double time : {0.0, 0.37}) {
      const LoadOptions options{.time = time, .bake_transforms = baked};
      const std::vector<Place> near = points_from(scene_around(Place::Zero()).load(options), Place::Zero());
      ASSERT_EQ(near.size(), 5u * 3 + 2);
      for (const Place& place :
           {Place(1e3, 1, 0), Place(1e6, 2e5, 9e5), Place(4.7e6, 9.4e5, 4.23e6), Place(-6e8, 0, 0.1)}) {
        SCOPED_TRACE(place.transpose());
        const Scene scene = scene_around(place).load(options);
        const std::vector<Place> far = points_from(scene, place);
        ASSERT_EQ(far.size(), near.size());
        // The centre is found in single precision; the scene lies around it as well as that is known.
        const double rounding = 4e-7 * (5.0 + 2.0 * place.norm() * 0x1p-23);
        for (std::size_t i = 0; i < far.size(); ++i) EXPECT_LT((far[i] - near[i]).norm(), rounding) << i;
      }
    }
  }
}

TEST(FarOrigin, OfASkinAloneIsItsPlace) {
  AnimatedFile file;
  const int joint = file.node({{"translation", {4.7e6, 9.4e5, 4.23e6}}});
  file.add("skins", {{"joints", {joint}}});
  file.node({{"mesh", file.mesh(triangle_of_joint(file))}, {"skin", 0}});
  const Scene scene = file.load();
  EXPECT_NEAR(world_area(scene, scene.instances.at(0), 0), 0.5, 1e-6);
}

}  // namespace
}  // namespace gatelight::scene
