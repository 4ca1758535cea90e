#include <gtest/gtest.h>

#include <cstdlib>

#include "scene/gltf.h"

namespace gatelight::scene {
namespace {

struct Known {
  const char* file;
  std::size_t triangles;  ///< each instance counted
  Vec3 low;
  Vec3 high;
  std::size_t images;
};

void PrintTo(const Known& known, std::ostream* out) {
  *out << known.file;
}

class RealScene : public ::testing::TestWithParam<Known> {};

TEST_P(RealScene, HasItsKnownTrianglesAndBounds) {
  const char* scenes = std::getenv("GATELIGHT_SCENES");
  if (!scenes) GTEST_SKIP() << "GATELIGHT_SCENES is not set";
  const Scene scene = load_gltf(std::filesystem::path(scenes) / GetParam().file);
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  EXPECT_EQ(count_triangles(scene), GetParam().triangles);
  EXPECT_LT((scene.bounds.min() - GetParam().low).cwiseAbs().maxCoeff(), 0.06f)
      << scene.bounds.min().transpose();
  EXPECT_LT((scene.bounds.max() - GetParam().high).cwiseAbs().maxCoeff(), 0.06f)
      << scene.bounds.max().transpose();
  EXPECT_EQ(scene.images.size(), GetParam().images);
  EXPECT_FALSE(scene.cameras.empty());
  EXPECT_LT(geometry_bytes(scene), GetParam().triangles * 64) << "bytes a triangle";
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.mesh_of(instance);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_EQ(mesh.tangents.empty(), !scene.material_of(instance).normal_texture);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealScene,
    ::testing::Values(
        Known{"cornell/cornell-area.glb", 36, Vec3(-1, 0, -1), Vec3(1, 2, 1), 0},
        Known{"sponza/sponza.glb", 262267, Vec3(-12.0f, -0.8f, -7.4f), Vec3(11.2f, 8.9f, 6.9f), 33},
        Known{"country-kitchen/country-kitchen.glb", 1050941, Vec3(-3.1f, 0, -3.2f), Vec3(3.8f, 3.4f, 5.5f),
              11},
        Known{"salle-de-bain/salle-de-bain.glb", 449049, Vec3(-1.7f, 0, -2.3f), Vec3(1.7f, 3.4f, 2.3f), 1},
        Known{"bistro-exterior/bistro-exterior.glb", 1308885, Vec3(-57.9f, -1.2f, -84.6f),
              Vec3(25.1f, 26.5f, 36.0f), 66}));

}  // namespace
}  // namespace gatelight::scene
