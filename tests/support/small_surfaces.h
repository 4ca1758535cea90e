#pragma once
// Small meshes with every kind of edge and every choice of sides, as surfaces of a model.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "neural/model/model.h"
#include "tests/support/counter_random.h"

namespace gatelight::neural::testing {

struct OwnedMesh {
  std::vector<Float3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A SurfaceLayout with its data: layout() is valid as long as this lives and does not move.
struct OwnedSurfaces {
  std::vector<OwnedMesh> meshes;
  std::vector<SurfaceInstance> instances;

  SurfaceLayout layout() const {
    SurfaceLayout surfaces;
    for (const OwnedMesh& mesh : meshes) surfaces.meshes.push_back({mesh.positions, mesh.triangles});
    surfaces.instances = instances;
    return surfaces;
  }
};

/// Closed: an octahedron whose triangles are cut in four `subdivisions` times, on the unit sphere.
inline OwnedMesh make_sphere(int subdivisions) {
  OwnedMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int step = 0; step < subdivisions; ++step) {
    std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const std::pair key = std::minmax(a, b);
      const std::pair<std::uint32_t, std::uint32_t> edge{key.first, key.second};
      for (const auto& [known, vertex] : middles)
        if (known == edge) return vertex;
      Float3 sum;
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] = mesh.positions[a][axis] + mesh.positions[b][axis];
      const float length = std::hypot(sum[0], sum[1], sum[2]);
      for (float& coordinate : sum) coordinate /= length;
      mesh.positions.push_back(sum);
      middles.push_back({edge, static_cast<std::uint32_t>(mesh.positions.size() - 1)});
      return middles.back().second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// Open: cells x cells squares of two triangles over [0,1]^2, uneven by `height`.
inline OwnedMesh make_sheet(std::uint32_t cells, float height, std::uint64_t seed) {
  OwnedMesh mesh;
  Random random{seed};
  const std::uint32_t row = cells + 1;
  for (std::uint32_t y = 0; y < row; ++y)
    for (std::uint32_t x = 0; x < row; ++x)
      mesh.positions.push_back({static_cast<float>(x) / static_cast<float>(cells),
                                static_cast<float>(y) / static_cast<float>(cells), height * random.unit()});
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * row + x;
      mesh.triangles.push_back({a, a + 1, a + row + 1});
      mesh.triangles.push_back({a + row + 1, a + row, a});
    }
  return mesh;
}

/// Not a manifold: `blades` triangles on one edge, walked in both directions.
inline OwnedMesh make_fan(std::uint32_t blades) {
  OwnedMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}};
  for (std::uint32_t i = 0; i < blades; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(blades);
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.5f});
    if (i % 2 == 0)
      mesh.triangles.push_back({0, 1, i + 2});
    else
      mesh.triangles.push_back({1, 0, i + 2});
  }
  return mesh;
}

inline std::array<float, 12> scaled_and_moved(float scale, float x, float y, float z) {
  return {scale, 0, 0, 0, scale, 0, 0, 0, scale, x, y, z};
}

/// A sphere, a sheet with both sides, a fan with its back only, a sphere without storage and a tiny sphere
/// with triangles far below a node spacing of 0.3: 139 triangles.
inline std::shared_ptr<const OwnedSurfaces> make_small_surfaces() {
  auto surfaces = std::make_shared<OwnedSurfaces>();
  surfaces->meshes = {make_sphere(1), make_sheet(3, 0.2f, 5), make_fan(3)};
  surfaces->instances = {{0, scaled_and_moved(1, 0, 0, 0), Sides::front},
                         {1, scaled_and_moved(2, 3, 0, 0), Sides::both},
                         {2, scaled_and_moved(1, 0, 3, 0), Sides::back},
                         {0, scaled_and_moved(1, 3, 3, 0), Sides::none},
                         {0, scaled_and_moved(0.02f, 0, 0, 3), Sides::front}};
  return surfaces;
}

}  // namespace gatelight::neural::testing
