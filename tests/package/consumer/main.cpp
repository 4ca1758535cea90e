// A stranger's program: it finds the package and uses both libraries through their installed headers.
#include <cstdio>

#include "scene/scene.h"

int main() {
  gatelight::scene::Scene scene;
  gatelight::scene::Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  mesh.triangles = {{0, 1, 2}};
  scene.instances.emplace_back().mesh = 0;
  const std::size_t triangles = gatelight::scene::count_triangles(scene);
  std::printf("%zu triangle\n", triangles);
  return triangles == 1 ? 0 : 1;
}
