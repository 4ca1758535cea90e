// What a scene requires of the renderer, and volumes within others.

#include <gtest/gtest.h>

#include "scene/nested_volumes.h"
#include "scene/requirements.h"
#include "tests/support/scene_builder.h"

namespace gatelight::scene {
namespace {

using testing::SceneBuilder;
using Numbers = std::vector<std::uint32_t>;

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
  EXPECT_TRUE(with([](Material& m) { m.iridescence = 0.1f; }));
  EXPECT_FALSE(with([](Material& m) { m.anisotropy = 0.1f; }));
  EXPECT_TRUE(with([](Material& m) { m.sheen_color = Color(0, 0.1f, 0); }));
  EXPECT_TRUE(with([](Material& m) { m.transmission = 0.1f; }));
  EXPECT_TRUE(with([](Material& m) { m.diffuse_transmission = 0.1f; }));
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
  EXPECT_TRUE(r.alpha_blend && r.alpha() && r.transmission && r.volumes && r.unlit);
  EXPECT_TRUE(r.has_lobe("clearcoat") && r.has_lobe("sheen") && !r.has_lobe("iridescence"));
  EXPECT_FALSE(r.alpha_mask);
  EXPECT_TRUE(r.base_color_textures && r.metallic_roughness_textures && r.normal_maps && r.other_textures &&
              r.emission_textures);
  EXPECT_EQ(r.emissive_materials, 1u);
  scene.instances.clear();
  r = compute_requirements(scene);
  EXPECT_FALSE(r.alpha() || r.transmission || r.has_lobe("clearcoat") || r.base_color_textures ||
               r.triangles);
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

Material glass() {
  Material m = SceneBuilder::clear_glass();
  m.thickness = 1.0f;
  return m;
}

/// Boxes of glass, each with its own placement.
struct Boxes : SceneBuilder {
  int of_glass = material(glass());

  Instance& add(const Vec3& low, const Vec3& high, bool inwards = false) {
    box(of_glass, low, high, inwards);
    scene().instances.back().placement = static_cast<int>(scene().instances.size()) - 1;
    return scene().instances.back();
  }
  std::vector<std::uint32_t> numbers() { return find_nested_volumes(scene()).of_instance; }
};

TEST(NestedVolumes, SeparateBoxesAreNotListed) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {1, 1, 1});
  boxes.add({2, 0, 0}, {3, 1, 1});
  EXPECT_TRUE(find_nested_volumes(boxes.scene()).empty());
  EXPECT_FALSE(compute_requirements(boxes.scene()).nested_volumes);
}

TEST(NestedVolumes, TheInnerVolumeHasPriority) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {9, 9, 9});
  boxes.add({2, 2, 2}, {3, 3, 3});
  boxes.add({1, 1, 1}, {8, 8, 8});
  boxes.add({20, 0, 0}, {21, 1, 1});
  EXPECT_EQ(boxes.numbers(), (Numbers{2, 0, 1, kNoVolume}));
  EXPECT_EQ(find_nested_volumes(boxes.scene()).instances, (Numbers{1, 2, 0}));
  EXPECT_TRUE(compute_requirements(boxes.scene()).nested_volumes);
}

TEST(NestedVolumes, PrioritiesDecideBeforeSizesAndFileOrder) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {2, 2, 2});
  boxes.add({1, 0, 0}, {3, 2, 2});
  EXPECT_EQ(boxes.numbers(), (Numbers{0, 1}));
  boxes.scene().instances[1].dielectric_priority = 0.5f;
  EXPECT_EQ(boxes.numbers(), (Numbers{1, 0}));
  boxes.scene().instances[0].dielectric_priority = 2.0f;
  EXPECT_EQ(boxes.numbers(), (Numbers{0, 1}));
  boxes.scene().instances[0].dielectric_priority = -1.0f;
  EXPECT_EQ(boxes.numbers(), (Numbers{1, 0}));
}

TEST(NestedVolumes, OpenAndInvertedSurfacesHaveNoVolume) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {9, 9, 9});
  boxes.add({1, 1, 1}, {2, 2, 2}, true);
  boxes.add({3, 3, 3}, {4, 4, 4});
  boxes.scene().meshes[2].triangles.pop_back();
  EXPECT_TRUE(boxes.numbers().empty());
}

TEST(NestedVolumes, PrimitivesOfOnePlacementCloseOneVolume) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {9, 9, 9});
  boxes.add({1, 1, 1}, {2, 2, 2});
  // Splits the second box into two primitives; its lid is metal.
  Scene& scene = boxes.scene();
  Mesh& open = scene.meshes[1];
  Mesh lid = open;
  lid.triangles = {open.triangles.back()};
  lid.material = boxes.material(Material{});
  open.triangles.pop_back();
  scene.meshes.push_back(lid);
  Instance instance = scene.instances[1];
  instance.mesh = 2;
  scene.instances.push_back(instance);
  EXPECT_EQ(boxes.numbers(), (Numbers{1, 0, kNoVolume}));
  scene.instances[2].placement = 2;
  EXPECT_TRUE(boxes.numbers().empty());
}

TEST(NestedVolumes, EachClosedMaterialIsASeparateVolume) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {9, 9, 9});
  boxes.add({1, 1, 1}, {2, 2, 2});
  Scene& scene = boxes.scene();
  scene.instances[1].placement = scene.instances[0].placement;
  // Two shells of one material are one volume, which touches no other.
  EXPECT_TRUE(boxes.numbers().empty());
  scene.meshes[1].material = boxes.material(glass());
  EXPECT_EQ(boxes.numbers(), (Numbers{1, 0}));
}

TEST(NestedVolumes, AMaskedSurfaceBoundsNoVolume) {
  for (const bool masked : {false, true}) {
    Boxes boxes;
    boxes.add({0, 0, 0}, {9, 9, 9});
    boxes.add({1, 1, 1}, {2, 2, 2});
    Material see_through = glass();
    if (masked) see_through.alpha_mode = AlphaMode::mask;
    boxes.scene().meshes[1].material = boxes.material(see_through);
    EXPECT_EQ(boxes.numbers().empty(), masked);
  }
}

TEST(NestedVolumes, VerticesThatDifferByRoundingAreMerged) {
  for (const float gap : {1e-6f, 1e-3f}) {
    Boxes boxes;
    boxes.add({0, 0, 0}, {9, 9, 9});
    // Each triangle has its own vertices, which a grid could separate.
    Mesh cut;
    boxes.add({1.1f, 1.2f, 1.3f}, {2.7f, 2.9f, 3.1f});
    const Mesh whole = boxes.scene().meshes[1];
    cut.material = whole.material;
    std::uint32_t number = 0;
    for (const auto& triangle : whole.triangles) {
      for (const std::uint32_t corner : triangle)
        cut.positions.push_back(whole.positions[corner] +
                                Vec3::Constant(gap * static_cast<float>(number++ % 3)));
      cut.triangles.push_back({number - 3, number - 2, number - 1});
    }
    boxes.scene().meshes[1] = cut;
    EXPECT_EQ(boxes.numbers().empty(), gap > 1e-4f) << gap;
  }
}

TEST(NestedVolumes, ManyVolumesAtOnePlaceAreFast) {
  Boxes boxes;
  boxes.add({0, 0, 0}, {1, 1, 1}).baked = false;
  Scene& scene = boxes.scene();
  constexpr int kBodies = 1 << 18;
  scene.instances.resize(kBodies, scene.instances[0]);
  for (int i = 0; i < kBodies; ++i) scene.instances[static_cast<std::size_t>(i)].placement = i;
  const NestedVolumes nested = find_nested_volumes(scene);
  EXPECT_EQ(nested.instances.size(), static_cast<std::size_t>(kBodies));
  EXPECT_EQ(nested.of_instance[7], 7u);
}

TEST(NestedVolumes, SeamsAndPolesAreNoHoles) {
  Boxes boxes;
  for (int i = 0; i < 2; ++i) {
    boxes.sphere(boxes.of_glass, Vec3(0.3f, 100.0f, -7.0f), i == 0 ? 1.0f : 0.4f, 32, true);
    boxes.scene().instances.back().placement = i;
  }
  EXPECT_EQ(boxes.numbers(), (Numbers{1, 0}));
}

TEST(NestedVolumes, SharedMeshesCountForEachPlacement) {
  Boxes boxes;
  boxes.add({-1, -1, -1}, {1, 1, 1});
  Scene& scene = boxes.scene();
  scene.instances[0].baked = false;
  for (const float scale : {3.0f, -0.5f}) {
    Instance copy = scene.instances[0];
    copy.transform.scale(scale);
    copy.swaps_handedness = scale < 0.0f;
    copy.placement = static_cast<int>(scene.instances.size());
    scene.instances.push_back(copy);
  }
  EXPECT_EQ(boxes.numbers(), (Numbers{1, 2, 0}));
}

}  // namespace
}  // namespace gatelight::scene
