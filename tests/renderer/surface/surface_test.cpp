// Normal maps in mirrored instances and from behind: the surface that is seen does not depend on how its mesh
// came to its place.

#include "renderer/surface/surface.h"

#include <gtest/gtest.h>

#include "scene/bake.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::SceneBuilder;
using scene::Affine;

/// A square in the xy plane, moved by `transform`. Its normal map leans the normals towards the tangent x and
/// the bitangent y; its clear coat has the same map, half as strong.
scene::Scene leaning(const Affine& transform) {
  SceneBuilder builder;
  scene::Material material;
  material.normal_texture.texture = 0;
  material.clearcoat = 1.0f;
  material.clearcoat_normal_texture.texture = 0;
  material.clearcoat_normal_scale = 0.5f;
  scene::Mesh& mesh = builder.quad(builder.material(material), Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0));
  mesh.normals.assign(4, Vec3(0, 0, 1));
  mesh.tangents.assign(4, Vec4(1, 0, 0, 1));
  mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  scene::Scene& scene = builder.scene();
  scene.images.push_back({.name = "lean", .width = 1, .height = 1, .channels = 3, .pixels = {160, 220, 230}});
  scene.textures.push_back({.image = 0});
  scene.instances[0].baked = false;
  scene.instances[0].transform = transform;
  scene.instances[0].mirrors = transform.linear().determinant() < 0.0f;
  return scene;
}

struct Normals {
  Vec3 shading;
  Vec3 coat;
};

/// As a ray sees them that looks against `towards`.
Normals seen(const scene::Scene& scene, const Vec3& towards) {
  const Textures textures(scene);
  const Surfaces surfaces(scene, textures);
  Hit hit;
  hit.instance = 0;
  hit.primitive = 0;
  hit.u = 0.25f;
  hit.v = 0.25f;
  const Surface surface = surfaces.at(hit, -towards, 0.0f, 0.0f);
  return {surface.shading_normal, surface.coat_normal};
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-5f) << a.transpose() << " and " << b.transpose();
}

Affine turned_and_scaled(const Vec3& scale) {
  Affine transform(Eigen::AngleAxisf(0.7f, Vec3(1, 2, -1).normalized()));
  return transform.scale(scale);
}

TEST(NormalMaps, LeanTowardsTangentAndBitangent) {
  // Bytes 160, 220, 230 over 255, times two, less one.
  const Vec3 texel(160.0f / 127.5f - 1.0f, 220.0f / 127.5f - 1.0f, 230.0f / 127.5f - 1.0f);
  const Normals normals = seen(leaning(Affine::Identity()), Vec3(0.1f, 0.2f, 0.9f).normalized());
  expect_near(normals.shading, texel.normalized());
  expect_near(normals.coat, Vec3(0.5f * texel.x(), 0.5f * texel.y(), texel.z()).normalized());
}

TEST(NormalMaps, FromBehindLeanAsFromTheFront) {
  const Normals front = seen(leaning(Affine::Identity()), Vec3(0, 0, 1));
  const Normals back = seen(leaning(Affine::Identity()), Vec3(0, 0, -1));
  expect_near(back.shading, Vec3(front.shading.x(), front.shading.y(), -front.shading.z()));
  expect_near(back.coat, Vec3(front.coat.x(), front.coat.y(), -front.coat.z()));
}

TEST(NormalMaps, AMirroredInstanceShowsTheMirrorImage) {
  for (const Vec3& mirror : {Vec3(-1, 1, 1), Vec3(1, -1, 1), Vec3(1, 1, -1), Vec3(-1, -1, -1)}) {
    for (const Vec3& towards :
         {Vec3(0.2f, -0.3f, 0.8f).normalized(), Vec3(0.2f, -0.3f, -0.8f).normalized()}) {
      const Affine place = turned_and_scaled(mirror);
      const Normals here = seen(leaning(Affine::Identity()), towards);
      const Normals there = seen(leaning(place), place.linear() * towards);
      expect_near(there.shading, place.linear() * here.shading);
      expect_near(there.coat, place.linear() * here.coat);
    }
  }
}

TEST(NormalMaps, AnInstanceLooksLikeItsMeshMovedIntoTheWorld) {
  for (const Vec3& scale : {Vec3(2, 2, 2), Vec3(-2, 2, 2), Vec3(0.5f, -0.5f, 0.5f)}) {
    for (const Vec3& towards : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
      const scene::Scene placed = leaning(turned_and_scaled(scale));
      scene::Scene baked = placed;
      scene::bake_transforms(baked);
      ASSERT_TRUE(baked.instances[0].baked);
      const Vec3 world = turned_and_scaled(Vec3::Ones()).linear() * towards;
      expect_near(seen(placed, world).shading, seen(baked, world).shading);
      expect_near(seen(placed, world).coat, seen(baked, world).coat);
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
