#include "scene/requirements.h"

#include <gtest/gtest.h>

namespace gatelight::scene {
namespace {

/// One mesh of two triangles for each material.
Scene scene_of(std::vector<Material> materials) {
  Scene scene;
  scene.materials = std::move(materials);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Mesh mesh;
    mesh.material = static_cast<int>(i);
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
    scene.meshes.push_back(mesh);
    Instance instance;
    instance.mesh = static_cast<int>(i);
    instance.baked = true;
    scene.instances.push_back(instance);
  }
  return scene;
}

Material lambert() {
  Material m;
  m.metallic = 0.0f;
  m.specular = 0.0f;
  return m;
}

TEST(Requirements, AnEmptySceneNeedsNothing) {
  const SceneRequirements r = compute_requirements(Scene{});
  EXPECT_FALSE(r.triangles || r.two_sided || r.view_dependent || r.alpha() || r.transmission || r.instances ||
               r.delta_lights);
  EXPECT_EQ(r.emissive_triangles, 0u);
}

TEST(Requirements, OnlyLambertIsViewIndependent) {
  EXPECT_FALSE(compute_requirements(scene_of({lambert()})).view_dependent);
  EXPECT_TRUE(compute_requirements(scene_of({Material{}})).view_dependent);
  const auto with = [](auto change) {
    Material m = lambert();
    change(m);
    return compute_requirements(scene_of({m})).view_dependent;
  };
  EXPECT_TRUE(with([](Material& m) { m.specular = 0.1f; }));
  EXPECT_FALSE(with([](Material& m) { m.specular = 0.1f, m.ior = 1.0f; }));
  EXPECT_TRUE(with([](Material& m) { m.metallic = 0.1f; }));
  EXPECT_TRUE(with([](Material& m) { m.clearcoat = 0.1f; }));
  EXPECT_TRUE(with([](Material& m) { m.sheen_color = Color(0, 0.1f, 0); }));
  EXPECT_TRUE(with([](Material& m) { m.transmission = 0.1f; }));
  EXPECT_FALSE(with([](Material& m) { m.metallic = 1.0f, m.unlit = true; }));
}

TEST(Requirements, TwoSidedMeansAnOpaqueBack) {
  Material glass = lambert();
  glass.double_sided = true;
  glass.transmission = 1.0f;
  EXPECT_FALSE(compute_requirements(scene_of({glass})).two_sided);
  glass.transmission = 0.0f;
  EXPECT_TRUE(compute_requirements(scene_of({lambert(), glass})).two_sided);
}

TEST(Requirements, FeaturesAreFoundInUsedMaterialsOnly) {
  Material m = lambert();
  m.alpha_mode = AlphaMode::blend;
  m.transmission = 0.5f;
  m.thickness = 1.0f;
  m.clearcoat = 1.0f;
  m.sheen_color = Color(1, 1, 1);
  m.unlit = true;
  m.base_color_texture.texture = 0;
  m.metallic_roughness_texture.texture = 0;
  m.normal_texture.texture = 0;
  m.specular_texture.texture = 0;
  m.emission = Color(1, 0, 0);
  m.emission_texture.texture = 0;
  Scene scene = scene_of({m});
  SceneRequirements r = compute_requirements(scene);
  EXPECT_TRUE(r.alpha_blend && r.alpha() && r.transmission && r.volumes && r.clearcoat && r.sheen && r.unlit);
  EXPECT_FALSE(r.alpha_mask);
  EXPECT_TRUE(r.base_color_textures && r.metallic_roughness_textures && r.normal_maps && r.other_textures &&
              r.emission_textures);
  EXPECT_EQ(r.emissive_materials, 1u);
  scene.instances.clear();
  r = compute_requirements(scene);
  EXPECT_FALSE(r.alpha() || r.transmission || r.clearcoat || r.base_color_textures || r.triangles);
  EXPECT_EQ(r.emissive_materials, 0u);
}

TEST(Requirements, EmissiveTrianglesCountEachInstance) {
  Material lamp = lambert();
  lamp.emission = Color(0, 0, 2);
  Scene scene = scene_of({lamp, lambert()});
  EXPECT_EQ(compute_requirements(scene).emissive_triangles, 2u);
  EXPECT_FALSE(compute_requirements(scene).instances);
  scene.instances.push_back(scene.instances[0]);
  scene.instances.back().baked = false;
  EXPECT_EQ(compute_requirements(scene).emissive_triangles, 4u);
  EXPECT_TRUE(compute_requirements(scene).instances);
}

TEST(Requirements, LightsAndVertexColoursAreFound) {
  Scene scene = scene_of({lambert()});
  scene.meshes[0].colors.assign(3, Vec4(1, 0, 0, 1));
  scene.lights.resize(1);
  SceneRequirements r = compute_requirements(scene);
  EXPECT_TRUE(r.vertex_colors && r.delta_lights);
  EXPECT_FALSE(r.directional_lights);
  scene.lights[0].type = LightType::directional;
  EXPECT_TRUE(compute_requirements(scene).directional_lights);
}

}  // namespace
}  // namespace gatelight::scene
