// Transforms that are baked; scenes far from the origin, which have the shape of the same scene near it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "scene/bake.h"
#include "tests/support/animated_file.h"
#include "tests/support/gltf_parts.h"

namespace gatelight::scene {
namespace {

using Place = Eigen::Vector3d;

/// A bumpy mesh with every optional attribute.
Mesh make_mesh(std::uint32_t triangles, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
  const auto vector = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
  Mesh mesh;
  mesh.material = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    std::array<Vec3, 3> p = {vector(), vector(), vector()};
    const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const Vec3 tangent = (p[1] - p[0]).normalized();
    for (const Vec3& position : p) {
      mesh.positions.push_back(position);
      mesh.normals.push_back(n);
      mesh.tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(), t % 2 == 0 ? 1.0f : -1.0f);
      mesh.uv0.emplace_back(uniform(random), uniform(random));
    }
  }
  return mesh;
}

Affine make_transform(std::uint32_t seed, bool mirror) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0.5f, 2.0f);
  Affine t = Affine::Identity();
  t.translate(Vec3(uniform(random), uniform(random), uniform(random)));
  t.rotate(Eigen::AngleAxisf(uniform(random), Vec3(1, 2, 3).normalized()));
  t.scale(Vec3(uniform(random) * (mirror ? -1.0f : 1.0f), uniform(random), uniform(random)));
  return t;
}

Scene make_scene(const std::vector<int>& meshes_of_instances, std::uint32_t triangles = 5) {
  Scene scene;
  scene.materials.resize(1);
  int count = 0;
  for (const int m : meshes_of_instances) count = std::max(count, m + 1);
  for (int m = 0; m < count; ++m) scene.meshes.push_back(make_mesh(triangles, static_cast<std::uint32_t>(m)));
  std::uint32_t seed = 100;
  for (const int m : meshes_of_instances) {
    Instance instance;
    instance.mesh = m;
    ++seed;
    instance.transform = make_transform(seed, seed % 2 == 0);
    instance.swaps_handedness = instance.transform.linear().determinant() < 0.0f;
    scene.instances.push_back(instance);
  }
  return scene;
}

/// Expects the same corners and front of every triangle; a baked mirror may list corners in reverse order.
void expect_same_world(const Scene& a, const Scene& b) {
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (std::size_t i = 0; i < a.instances.size(); ++i) {
    const Instance& ia = a.instances[i];
    const Instance& ib = b.instances[i];
    ASSERT_EQ(a.mesh_of(ia).triangles.size(), b.mesh_of(ib).triangles.size());
    for (std::uint32_t t = 0; t < a.mesh_of(ia).triangles.size(); ++t) {
      std::array<Vec3, 3> pb = world_triangle(b, ib, t);
      if (ia.swaps_handedness != ib.swaps_handedness) std::swap(pb[1], pb[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_TRUE(world_triangle(a, ia, t)[k].isApprox(pb[k], 1e-5f)) << i << " " << t;
      }
      EXPECT_TRUE(world_normal(a, ia, t).isApprox(world_normal(b, ib, t), 1e-4f)) << i << " " << t;
    }
  }
}

TEST(Bake, BakedEqualsNotBaked) {
  const Scene before = make_scene({0, 1, 2, 2, 3, 3, 3});
  for (const std::size_t budget : {0u, 5u, 1000u}) {
    Scene after = before;
    bake_transforms(after, budget);
    expect_same_world(before, after);
  }
}

TEST(Bake, AMirroredMeshKeepsItsFront) {
  Scene scene = make_scene({0, 1});  // seeds 101 and 102: plain and mirrored
  ASSERT_TRUE(scene.instances[1].swaps_handedness);
  bake_transforms(scene);
  for (const Instance& instance : scene.instances) {
    EXPECT_TRUE(instance.baked);
    EXPECT_FALSE(instance.swaps_handedness);
    const Mesh& mesh = scene.mesh_of(instance);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      // The vertex normals still equal the triangles' normals, on the same side.
      const Vec3 n = world_normal(scene, instance, t).normalized();
      for (const std::uint32_t v : mesh.triangles[t]) EXPECT_NEAR(mesh.normals[v].dot(n), 1.0f, 1e-4f);
    }
  }
}

TEST(Bake, TangentFramesFollowTheSurface) {
  const Scene before = make_scene({0, 1});
  Scene after = before;
  bake_transforms(after);
  for (std::size_t i = 0; i < 2; ++i) {
    const Mesh& source = before.meshes[i];
    const Mesh& baked = after.mesh_of(after.instances[i]);
    const Eigen::Matrix3f linear = before.instances[i].transform.linear();
    for (std::size_t v = 0; v < source.positions.size(); ++v) {
      const Vec3 tangent = source.tangents[v].head<3>();
      const Vec3 bitangent = source.normals[v].cross(tangent) * source.tangents[v].w();
      const Vec3 world_tangent = baked.tangents[v].head<3>();
      const Vec3 world_bitangent = baked.normals[v].cross(world_tangent) * baked.tangents[v].w();
      EXPECT_GT(world_tangent.dot(linear * tangent), 0.0f);
      EXPECT_GT(world_bitangent.dot(linear * bitangent), 0.0f)
          << "the picture is not mirrored against the surface";
      EXPECT_NEAR(world_tangent.norm(), 1.0f, 1e-5f);
    }
  }
}

TEST(Bake, SharedMeshesAreCopiedWithinTheBudget) {
  // Copies cost 5 triangles for mesh 0, 10 for mesh 1.
  const Scene before = make_scene({0, 0, 1, 1, 1});
  const auto baked = [&](std::size_t budget) {
    Scene scene = before;
    bake_transforms(scene, budget);
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) count += instance.baked;
    return std::pair(count, scene.meshes.size());
  };
  EXPECT_EQ(baked(4), std::pair(std::size_t{0}, std::size_t{2}));
  EXPECT_EQ(baked(5), std::pair(std::size_t{2}, std::size_t{3}));
  EXPECT_EQ(baked(14), std::pair(std::size_t{2}, std::size_t{3}));
  EXPECT_EQ(baked(15), std::pair(std::size_t{5}, std::size_t{5}));
}

TEST(Bake, FlatInstancesAreAlwaysCopied) {
  Scene scene = make_scene({0, 0, 0});
  scene.instances[1].transform.linear().col(1).setZero();
  scene.instances[1].swaps_handedness = false;
  bake_transforms(scene, 0);
  EXPECT_FALSE(scene.instances[0].baked);
  EXPECT_TRUE(scene.instances[1].baked) << "no ray can be carried into its space";
  EXPECT_FALSE(scene.instances[2].baked);
  for (const Vec3& n : scene.mesh_of(scene.instances[1]).normals) EXPECT_NEAR(n.norm(), 1.0f, 1e-5f);
}

TEST(Bake, UnusedMeshesAreDroppedAndBoundsAreSet) {
  Scene scene = make_scene({2});
  bake_transforms(scene);
  EXPECT_EQ(scene.meshes.size(), 1u);
  Box expected;
  for (const Vec3& p : scene.meshes[0].positions) expected.extend(p);
  EXPECT_EQ(scene.bounds.min(), expected.min());
  EXPECT_EQ(scene.bounds.max(), expected.max());
}

TEST(Bake, BakingTwiceChangesNothing) {
  Scene once = make_scene({0, 1, 1});
  bake_transforms(once);
  Scene twice = once;
  bake_transforms(twice);
  for (std::size_t i = 0; i < once.meshes.size(); ++i)
    EXPECT_EQ(once.meshes[i].positions, twice.meshes[i].positions);
}

TEST(Bake, TinyAndHugeScalesKeepUnitNormals) {
  for (const float scale : {1e-15f, 1e-6f, 1e6f}) {
    Scene scene = make_scene({0});
    scene.instances[0].transform = Affine::Identity();
    scene.instances[0].transform.linear() *= scale;
    scene.instances[0].swaps_handedness = false;
    const std::vector<Vec3> before = scene.meshes[0].normals;
    bake_transforms(scene);
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_TRUE(scene.meshes[0].normals[i].isApprox(before[i], 1e-5f));
  }
}

TEST(Bake, AMirroringNodeKeepsItsFrontAtAnySize) {
  GltfBuilder file = triangle_file();
  file.root["nodes"][0]["scale"] = {-1, 1, 1};
  for (const bool bake : {false, true}) {
    const Scene scene = file.load({.bake_transforms = bake});
    EXPECT_EQ(scene.instances[0].swaps_handedness, !bake);
    EXPECT_TRUE(world_normal(scene, scene.instances[0], 0).isApprox(Vec3(0, 0, 1)));
  }
  file.root["nodes"][0]["scale"] = {-1e-16, 1e-16, 1e-16};
  EXPECT_TRUE(file.load({.bake_transforms = false}).instances.at(0).swaps_handedness);
}

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
