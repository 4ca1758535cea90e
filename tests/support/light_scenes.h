#pragma once
// Scenes made of emissive triangles, and the closed form of their irradiance at a point.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "renderer/image/image_write.h"
#include "renderer/light/lights.h"
#include "scene/scene.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::testing {
using Triangle = std::array<Vec3, 3>;

/// Adds a mesh with a material of its own, used by one instance; returns the index of the instance.
inline std::uint32_t add_light(scene::Scene& scene, const std::vector<Triangle>& triangles,
                               const scene::Material& material) {
  scene::Mesh mesh;
  mesh.material = static_cast<int>(scene.materials.size());
  for (const Triangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), t.begin(), t.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
    for (const Vec3& p : t) scene.bounds.extend(p);
  }
  scene::Instance instance;
  instance.mesh = static_cast<int>(scene.meshes.size());
  instance.baked = true;
  scene.materials.push_back(material);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(instance);
  return static_cast<std::uint32_t>(scene.instances.size() - 1);
}

inline std::uint32_t add_light(scene::Scene& scene, const std::vector<Triangle>& triangles,
                               const Color& radiance, bool double_sided = false) {
  scene::Material material;
  material.emission = radiance;
  material.double_sided = double_sided;
  return add_light(scene, triangles, material);
}

/// Two triangles over a parallelogram; the front is where cross(edge1, edge2) points.
inline std::vector<Triangle> quad(const Vec3& corner, const Vec3& edge1, const Vec3& edge2) {
  return {{corner, corner + edge1, corner + edge1 + edge2}, {corner, corner + edge1 + edge2, corner + edge2}};
}

/// A sky picture in which every texel has this radiance: found by light samples, unlike a constant sky.
inline renderer::EnvironmentOptions uniform_picture(const tests::TemporaryFolder& folder, float radiance) {
  renderer::Picture picture{.width = 8, .height = 4};
  renderer::Layer beauty{.channels = {"R", "G", "B"}, .values = std::vector<float>(8 * 4 * 3, radiance)};
  beauty.full_precision = true;
  picture.layers.push_back(beauty);
  renderer::EnvironmentOptions options;
  options.file = (folder / "sky.exr").string();
  renderer::write_image(picture, options.file);
  return options;
}

/// A scene with its Lights and all the data that they refer to.
struct LitScene {
  scene::Scene scene;
  renderer::Textures textures;
  renderer::Environment environment;
  renderer::Lights lights;

  explicit LitScene(scene::Scene s, renderer::LightSelection selection = renderer::LightSelection::tree,
                    const renderer::EnvironmentOptions& options = {})
      : scene(std::move(s)),
        textures(scene),
        environment(options),
        lights(scene, textures, environment, selection) {}
  LitScene(const LitScene&) = delete;
};

/// A sample of the lights at p with normal n.
inline renderer::LightSample draw_light(const renderer::Lights& lights, const Vec3& p, const Vec3& n,
                                        Random& random) {
  const float u_select = random.uniform_float();
  return lights.sample(p, n, u_select, next_2d(random));
}

/// Irradiance of a polygon of radiance 1 at p with normal n: Lambert's formula after cutting away what lies
/// below the horizon. Signed: positive when its corners run clockwise seen from p.
inline double polygon_irradiance(const std::vector<Eigen::Vector3d>& polygon, const Eigen::Vector3d& p,
                                 const Eigen::Vector3d& n) {
  std::vector<Eigen::Vector3d> above;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d a = polygon[i] - p;
    const Eigen::Vector3d b = polygon[(i + 1) % polygon.size()] - p;
    const double ha = a.dot(n);
    const double hb = b.dot(n);
    if (ha >= 0.0) above.push_back(a);
    if ((ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0)) above.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < above.size(); ++i) {
    const Eigen::Vector3d a = above[i].normalized();
    const Eigen::Vector3d b = above[(i + 1) % above.size()].normalized();
    const Eigen::Vector3d cross = a.cross(b);
    if (cross.norm() > 0.0) sum += std::atan2(cross.norm(), a.dot(b)) * cross.normalized().dot(n);
  }
  return 0.5 * sum;
}

/// Irradiance of one-sided triangles of radiance 1, occlusion ignored.
inline double triangles_irradiance(const std::vector<Triangle>& triangles, const Vec3& p, const Vec3& n) {
  double sum = 0.0;
  for (const Triangle& t : triangles) {
    // The front is counter-clockwise, which Lambert's formula counts as negative.
    sum += std::max(0.0, -polygon_irradiance({t[0].cast<double>(), t[1].cast<double>(), t[2].cast<double>()},
                                             p.cast<double>(), n.cast<double>()));
  }
  return sum;
}

/// Barycentric weights of the second and third corner where the line from p along wi meets the plane, and
/// the distance; in double precision.
struct PlaneHit {
  double b1 = 0.0;
  double b2 = 0.0;
  double distance = 0.0;
  bool inside(double tolerance) const {
    return distance > 0.0 && b1 >= -tolerance && b2 >= -tolerance && b1 + b2 <= 1.0 + tolerance;
  }
};

inline PlaneHit meet(const Triangle& t, const Vec3& p, const Vec3& wi) {
  const Eigen::Vector3d a = t[0].cast<double>();
  const Eigen::Vector3d e1 = t[1].cast<double>() - a;
  const Eigen::Vector3d e2 = t[2].cast<double>() - a;
  const Eigen::Vector3d o = p.cast<double>() - a;
  const Eigen::Vector3d d = wi.cast<double>();
  const Eigen::Vector3d q = d.cross(e2);
  const double determinant = e1.dot(q);
  if (determinant == 0.0) return {};
  const Eigen::Vector3d r = o.cross(e1);
  return {o.dot(q) / determinant, d.dot(r) / determinant, e2.dot(r) / determinant};
}

}  // namespace gatelight::testing
