#include "scene/scene.h"

#include "scene/triangle_normal.h"

namespace gatelight::scene {

std::array<Vec3, 3> world_triangle(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  const Mesh& mesh = scene.mesh_of(instance);
  const std::array<std::uint32_t, 3>& t = mesh.triangles[primitive];
  if (instance.baked) return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
  return {instance.transform * mesh.positions[t[0]], instance.transform * mesh.positions[t[1]],
          instance.transform * mesh.positions[t[2]]};
}

Vec3 world_normal(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  const std::array<Vec3, 3> p = world_triangle(scene, instance, primitive);
  float twice_area = 0.0f;
  const Vec3 n = triangle_normal(p[0], p[1], p[2], twice_area);
  return instance.swaps_handedness ? Vec3(-n) : n;
}

double world_area(const Scene& scene, const Instance& instance, std::uint32_t primitive) {
  const std::array<Vec3, 3> p = world_triangle(scene, instance, primitive);
  const Eigen::Vector3d corner = p[0].cast<double>();
  return 0.5 * (p[1].cast<double>() - corner).cross(p[2].cast<double>() - corner).norm();
}

std::size_t count_triangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Instance& instance : scene.instances) count += scene.mesh_of(instance).triangles.size();
  return count;
}

namespace {
template <typename Values>
std::size_t bytes(const Values& v) {
  return v.size() * sizeof(v[0]);
}
}  // namespace

std::size_t geometry_bytes(const Scene& scene) {
  std::size_t total = 0;
  for (const Mesh& m : scene.meshes) {
    total += bytes(m.positions) + bytes(m.normals) + bytes(m.tangents) + bytes(m.uv0) + bytes(m.uv1) +
             bytes(m.colors) + bytes(m.triangles);
  }
  for (const std::vector<Affine>& states : scene.shutter.transforms) total += states.size() * sizeof(Affine);
  for (const std::vector<DeformedVertices>& states : scene.shutter.vertices) {
    for (const DeformedVertices& v : states)
      total += bytes(v.positions) + bytes(v.normals) + bytes(v.tangents);
  }
  return total;
}

std::size_t image_bytes(const Scene& scene) {
  std::size_t total = 0;
  for (const Image& image : scene.images) total += bytes(image.pixels) + bytes(image.pixels_16);
  if (scene.image_light) {
    for (const Image& face : scene.image_light->faces) total += bytes(face.pixels);
  }
  return total;
}

}  // namespace gatelight::scene
