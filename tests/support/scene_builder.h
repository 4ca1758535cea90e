#pragma once
// Small scenes made in code: quads, boxes, spheres with a material each.

#include <array>
#include <cmath>
#include <utility>

#include "scene/scene.h"

namespace gatelight::testing {

class SceneBuilder {
 public:
  SceneBuilder() { scene_.path = "built.glb"; }

  /// A matte material without any specular layer: exactly Lambert.
  static scene::Material lambert(const Color& albedo, const Color& emission = Color::Zero()) {
    scene::Material m;
    m.base_color = albedo;
    m.metallic = 0.0f;
    m.roughness = 1.0f;
    m.specular = 0.0f;
    m.emission = emission;
    return m;
  }

  /// Smooth and thin-walled: a pane.
  static scene::Material clear_glass() {
    scene::Material m;
    m.metallic = 0.0f;
    m.roughness = 0.0f;
    m.transmission = 1.0f;
    return m;
  }

  /// Adds a material, returns its index.
  int material(const scene::Material& m) {
    scene_.materials.push_back(m);
    return static_cast<int>(scene_.materials.size()) - 1;
  }

  /// Adds a mesh in world space. Counter-clockwise is the front.
  scene::Mesh& mesh(int material, PaddedVector<Vec3> positions,
                    std::vector<std::array<std::uint32_t, 3>> triangles) {
    scene::Mesh m;
    m.material = material;
    m.positions = std::move(positions);
    m.triangles = std::move(triangles);
    for (const Vec3& p : m.positions) scene_.bounds.extend(p);
    scene::Instance instance;
    instance.mesh = static_cast<int>(scene_.meshes.size());
    instance.baked = true;
    scene_.meshes.push_back(std::move(m));
    scene_.instances.push_back(instance);
    return scene_.meshes.back();
  }

  /// corner, corner + a, corner + a + b, corner + b; the front is along a x b.
  scene::Mesh& quad(int material, const Vec3& corner, const Vec3& a, const Vec3& b) {
    return mesh(material, {corner, corner + a, corner + a + b, corner + b}, {{0, 1, 2}, {0, 2, 3}});
  }

  /// Fronts look outwards, or inwards.
  void box(int material, const Vec3& low, const Vec3& high, bool inwards = false) {
    PaddedVector<Vec3> p;
    for (int i = 0; i < 8; ++i) {
      p.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
    }
    std::vector<std::array<std::uint32_t, 3>> t{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                                {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                                {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    if (inwards) {
      for (auto& triangle : t) std::swap(triangle[1], triangle[2]);
    }
    mesh(material, p, t);
  }

  /// Latitude-longitude sphere, fronts outwards; smooth normals on request.
  scene::Mesh& sphere(int material, const Vec3& center, float radius, int segments, bool smooth) {
    PaddedVector<Vec3> p;
    std::vector<std::array<std::uint32_t, 3>> t;
    const int rings = segments / 2;
    for (int i = 0; i <= rings; ++i) {
      for (int j = 0; j <= segments; ++j) {
        const float theta = kPi * static_cast<float>(i) / static_cast<float>(rings);
        const float phi = 2.0f * kPi * static_cast<float>(j % segments) / static_cast<float>(segments);
        p.push_back(center + radius * Vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                           -std::sin(theta) * std::sin(phi)));
      }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (segments + 1) + j); };
    for (int i = 0; i < rings; ++i) {
      for (int j = 0; j < segments; ++j) {
        if (i > 0) t.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + 1 < rings) t.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
    scene::Mesh& m = mesh(material, p, t);
    if (smooth) {
      for (const Vec3& x : m.positions) m.normals.push_back((x - center).normalized());
    }
    return m;
  }

  scene::Scene& scene() { return scene_; }

 private:
  scene::Scene scene_;
};

}  // namespace gatelight::testing
