// The layout of a scene for the cache: welded meshes, transforms, and sides with the same meaning in renderer
// and neural for every kind of instance.

#include "renderer/cache/scene_layout.h"

#include <gtest/gtest.h>

#include <string>

#include "neural/layout/build_gate_layout.h"
#include "renderer/cache/surface_points.h"
#include "renderer/transport/world.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using testing::SceneBuilder;

std::vector<neural::Sides> fronts(const scene::Scene& scene) {
  return std::vector<neural::Sides>(scene.instances.size(), neural::Sides::front);
}

TEST(SurfaceLayout, VerticesAtOnePositionAreWelded) {
  SceneBuilder builder;
  const int matte = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  // A quad whose triangles share no index, as files with a seam of normals along the diagonal have it.
  builder.mesh(matte, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {-0.0f, 1, 0}},
               {{0, 1, 2}, {3, 4, 5}});
  builder.quad(matte, Vec3(5, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  const WeldedMeshes meshes(builder.scene());
  const neural::SurfaceLayout layout = meshes.layout(builder.scene(), fronts(builder.scene()));
  ASSERT_EQ(layout.meshes.size(), 2u);
  const neural::SurfaceMesh& quad = layout.meshes[0];
  ASSERT_EQ(quad.triangles.size(), 2u);
  EXPECT_EQ(quad.triangles[0][0], quad.triangles[1][0]);
  EXPECT_EQ(quad.triangles[0][2], quad.triangles[1][1]);
  const neural::Float3 expected[2][3] = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                                         {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(quad.positions[quad.triangles[t][c]], expected[t][c]);
  }
  // Four corners, not six: as many nodes as the quad that shares its indices.
  neural::GateOptions options;
  options.rule = neural::ResolutionRule::fixed;
  options.fixed_resolution = 1;
  options.stack = {1};
  EXPECT_EQ(neural::build_gate_layout(layout, options).node_count, 8u);
}

/// One triangle, counter-clockwise seen from +z in the space of its mesh, placed by `transform`.
struct OneTriangle {
  explicit OneTriangle(const scene::Material& material, const Affine& transform, bool baked = false) {
    builder.mesh(builder.material(material), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    scene::Instance& instance = builder.scene().instances[0];
    instance.transform = transform;
    instance.baked = baked;
    instance.swaps_handedness = transform.linear().determinant() < 0.0f;
    Box& bounds = builder.scene().bounds;
    bounds.setEmpty();
    for (const Vec3& p : scene::world_triangle(builder.scene(), instance, 0)) bounds.extend(p);
  }
  SceneBuilder builder;
};

Affine placed(bool mirrors) {
  Affine transform = Affine::Identity();
  transform.translate(Vec3(3, -2, 1));
  transform.rotate(Eigen::AngleAxisf(0.7f, Vec3(1, 2, 3).normalized()));
  transform.scale(Vec3(mirrors ? -2.0f : 2.0f, 1.5f, 1.0f));
  return transform;
}

TEST(SurfaceLayout, TransformsLeadToTheSameWorld) {
  OneTriangle made(SceneBuilder::lambert(Color::Constant(0.5f)), placed(true));
  const scene::Scene& scene = made.builder.scene();
  const WeldedMeshes meshes(scene);
  const neural::SurfaceLayout layout = meshes.layout(scene, {neural::Sides::both});
  ASSERT_EQ(layout.instances.size(), 1u);
  EXPECT_EQ(layout.instances[0].mesh, 0u);
  EXPECT_EQ(layout.instances[0].sides, neural::Sides::both);
  const std::array<float, 12>& m = layout.instances[0].object_to_world;
  const std::array<Vec3, 3> corners = scene::world_triangle(scene, scene.instances[0], 0);
  for (std::size_t c = 0; c < 3; ++c) {
    const neural::Float3& p = layout.meshes[0].positions[layout.meshes[0].triangles[0][c]];
    for (std::size_t row = 0; row < 3; ++row) {
      const float x = m[row] * p[0] + m[3 + row] * p[1] + m[6 + row] * p[2] + m[9 + row];
      EXPECT_NEAR(x, corners[c][static_cast<Eigen::Index>(row)], 1e-6f);
    }
  }
}

/// neural's side of a viewer: 0 where the right-hand normal of the corners points, in the world.
std::uint32_t side_by_corners(const scene::Scene& scene, const Vec3& direction) {
  const std::array<Vec3, 3> p = scene::world_triangle(scene, scene.instances[0], 0);
  return (p[1] - p[0]).cross(p[2] - p[0]).dot(direction) <= 0.0f ? 0u : 1u;
}

struct Kind {
  bool mirrors;
  bool double_sided;
  bool glass;
};

class SidesOfKinds : public ::testing::TestWithParam<Kind> {};

TEST_P(SidesOfKinds, TheSideTowardsTheViewerFollowsTheWindingAndHasStorage) {
  const auto [mirrors, double_sided, glass] = GetParam();
  scene::Material material = SceneBuilder::lambert(Color::Constant(0.5f));
  material.double_sided = double_sided;
  if (glass) material.transmission = 0.5f;
  OneTriangle made(material, placed(mirrors));
  const scene::Scene& scene = made.builder.scene();
  const scene::Instance& instance = scene.instances[0];
  const World world(scene);

  const neural::Sides possible = possible_sides(scene, instance);
  EXPECT_EQ(possible, double_sided || glass ? neural::Sides::both
                      : mirrors             ? neural::Sides::back
                                            : neural::Sides::front);
  const WeldedMeshes meshes(scene);
  const neural::GateLayout layout = neural::build_gate_layout(meshes.layout(scene, {possible}), {});

  const Vec3 front = scene::world_normal(scene, instance, 0).normalized();
  const std::array<Vec3, 3> corners = scene::world_triangle(scene, instance, 0);
  const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
  std::uint32_t seen_sides = 0;
  for (const bool from_front : {true, false}) {
    Ray ray;
    ray.direction = from_front ? Vec3(-front) : front;
    ray.origin = middle - 2.0f * ray.direction;
    Hit hit;
    world.accel.intersect(std::span(&ray, 1), std::span(&hit, 1), false);
    ASSERT_TRUE(hit);
    const Surface surface = world.surfaces.at(hit, ray.direction, 0.0f, 0.5f);
    EXPECT_EQ(surface.front, from_front);
    const std::uint32_t side = side_of(surface.front, instance.swaps_handedness);
    EXPECT_EQ(side, side_by_corners(scene, ray.direction));

    SurfacePoints points;
    points.push_back(surface_point(hit, side, -ray.direction, surface, Color::Ones()));
    EXPECT_EQ(points.surface(0), neural::surface_index(0, side));
    EXPECT_GT(layout.surfaces[points.surface(0)].triangle_count, 0u);
    if (from_front) {
      EXPECT_TRUE(has_side(possible, side)) << "fronts are always visible";
    }
    seen_sides |= 1u << side;
  }
  EXPECT_EQ(seen_sides, 3u);
  // Both sides share nodes where only one side is stored, else they have separate ones.
  const bool shared = layout.levels[0].vertex_base == layout.levels[layout.stack].vertex_base;
  EXPECT_EQ(shared, possible != neural::Sides::both);
}

INSTANTIATE_TEST_SUITE_P(All, SidesOfKinds,
                         ::testing::Values(Kind{false, false, false}, Kind{true, false, false},
                                           Kind{false, true, false}, Kind{true, true, false},
                                           Kind{false, false, true}, Kind{true, false, true}),
                         [](const auto& kind) {
                           return std::string(kind.param.mirrors ? "Mirrored" : "Plain") +
                                  (kind.param.double_sided ? "DoubleSided" : "") +
                                  (kind.param.glass ? "Glass" : "");
                         });

}  // namespace
}  // namespace gatelight::renderer
