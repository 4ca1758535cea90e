#include "renderer/cache/scene_layout.h"

#include "base/parallel/loops.h"
#include "renderer/cache/surface_points.h"

namespace gatelight::renderer {

WeldedMeshes::WeldedMeshes(const scene::Scene& scene)
    : positions_(scene.meshes.size()), triangles_(scene.meshes.size()) {
  for_each(scene.meshes.size(), [&](std::size_t i) {
    const scene::Mesh& mesh = scene.meshes[i];
    positions_[i].reserve(mesh.positions.size());
    for (const Vec3& p : mesh.positions) positions_[i].push_back({p.x(), p.y(), p.z()});
    const std::vector<std::uint32_t> welded = neural::weld_vertices(positions_[i]);
    triangles_[i].reserve(mesh.triangles.size());
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
      triangles_[i].push_back({welded[t[0]], welded[t[1]], welded[t[2]]});
  });
}

neural::SurfaceLayout WeldedMeshes::layout(const scene::Scene& scene, const std::vector<neural::Sides>& sides,
                                           const std::vector<float>& spacing_scales) const {
  neural::SurfaceLayout layout;
  for (std::size_t i = 0; i < positions_.size(); ++i) layout.meshes.push_back({positions_[i], triangles_[i]});
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    neural::SurfaceInstance& surface = layout.instances.emplace_back();
    surface.mesh = static_cast<std::uint32_t>(instance.mesh);
    const Eigen::Matrix<float, 3, 4> matrix = instance.transform.matrix().topRows<3>();
    Eigen::Map<Eigen::Matrix<float, 3, 4>>(surface.object_to_world.data()) = matrix;
    surface.sides = sides[i];
    if (!spacing_scales.empty()) surface.spacing_scale = spacing_scales[i];
  }
  return layout;
}

neural::Sides possible_sides(const scene::Scene& scene, const scene::Instance& instance) {
  const scene::Material& material = scene.material_of(instance);
  if (material.double_sided || material.transmits()) return neural::Sides::both;
  return instance.swaps_handedness ? neural::Sides::back : neural::Sides::front;
}

std::uint32_t surface_of_hit(const scene::Scene& scene, const Hit& hit, const Vec3& direction) {
  const scene::Instance& instance = scene.instances[hit.instance];
  const bool front = scene::world_normal(scene, instance, hit.primitive).dot(direction) <= 0.0f;
  return neural::surface_index(hit.instance, side_of(front, instance.swaps_handedness));
}

}  // namespace gatelight::renderer
