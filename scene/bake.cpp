#include "scene/bake.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace gatelight::scene {
namespace {

/// Transforming this many takes half a second.
constexpr std::size_t kExactVertices = 100'000'000;

void transform_mesh(Mesh& mesh, const Affine& transform, bool mirrors) {
  for (Vec3& p : mesh.positions) p = transform * p;
  const Eigen::Matrix3f linear = transform.linear();
  // The matrix is scaled first: a cofactor matrix holds products of two entries, which under- or overflow for
  // tiny or huge scales.
  const float scale = linear.cwiseAbs().maxCoeff();
  Affine unit = Affine::Identity();
  unit.linear() = linear / scale;
  const Eigen::Matrix3f to_normal = normal_matrix(unit);
  for (Vec3& n : mesh.normals) {
    const Vec3 world = (to_normal * n).stableNormalized();
    if (world.allFinite() && world.squaredNorm() > 0.5f) n = world;
  }
  for (Vec4& t : mesh.tangents) {
    const Vec3 world = (unit.linear() * t.head<3>()).stableNormalized();
    if (world.allFinite() && world.squaredNorm() > 0.5f) t.head<3>() = world;
    if (mirrors) t.w() = -t.w();
  }
  if (mirrors) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  }
}

/// Gives an instance its own copy of its mesh.
void unshare(Scene& scene, Instance& instance, std::vector<std::size_t>& uses) {
  --uses[static_cast<std::size_t>(instance.mesh)];
  Mesh copy = scene.mesh_of(instance);
  instance.mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(std::move(copy));
  uses.push_back(1);
}

}  // namespace

bool is_flat(const Affine& transform) {
  const Eigen::Matrix3f m = transform.linear();
  const float product = m.col(0).norm() * m.col(1).norm() * m.col(2).norm();
  return !(std::abs(m.determinant()) > 1e-6f * product) || !std::isnormal(product);
}

void bake_transforms(Scene& scene, std::size_t copy_budget_triangles) {
  std::vector<std::size_t> uses(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) ++uses[static_cast<std::size_t>(instance.mesh)];

  // The cheapest shared meshes are copied, as many as the budget allows.
  std::vector<std::size_t> order(scene.meshes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto cost = [&](std::size_t m) {
    return uses[m] < 2 ? std::size_t{0} : (uses[m] - 1) * scene.meshes[m].triangles.size();
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  std::vector<char> copied(scene.meshes.size(), 0);
  std::size_t spent = 0;
  for (const std::size_t m : order) {
    if (spent + cost(m) > copy_budget_triangles) break;
    spent += cost(m);
    copied[m] = 1;
  }
  for (Instance& instance : scene.instances) {
    const std::size_t m = static_cast<std::size_t>(instance.mesh);
    if (!instance.baked && !instance.moves && uses[m] > 1 && (copied[m] || is_flat(instance.transform))) {
      unshare(scene, instance, uses);
    }
  }
  drop_unused_meshes(scene);

  std::vector<std::size_t> last_uses(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) ++last_uses[static_cast<std::size_t>(instance.mesh)];
  tbb::parallel_for(std::size_t{0}, scene.instances.size(), [&](std::size_t i) {
    Instance& instance = scene.instances[i];
    const std::size_t m = static_cast<std::size_t>(instance.mesh);
    if (instance.baked || instance.moves || last_uses[m] != 1) return;
    transform_mesh(scene.meshes[m], instance.transform, instance.swaps_handedness);
    instance.transform = Affine::Identity();
    instance.swaps_handedness = false;
    instance.baked = true;
  });
  scene.bounds = compute_bounds(scene);
}

Box compute_bounds(const Scene& scene) {
  std::size_t work = 0;
  for (const Instance& instance : scene.instances) work += scene.mesh_of(instance).positions.size();
  const bool exact = work <= kExactVertices;

  std::vector<Box> local(scene.meshes.size());
  for (std::size_t i = 0; i < local.size(); ++i) {
    for (const Vec3& p : scene.meshes[i].positions) local[i].extend(p);
  }
  Box bounds;
  for (const Instance& instance : scene.instances) {
    const Box& box = local[static_cast<std::size_t>(instance.mesh)];
    if (box.isEmpty()) continue;
    if (instance.baked) {
      bounds.extend(box);
    } else if (exact) {
      for (const Vec3& p : scene.mesh_of(instance).positions) bounds.extend(instance.transform * p);
    } else {
      for (int corner = 0; corner < 8; ++corner) {
        bounds.extend(instance.transform * box.corner(static_cast<Box::CornerType>(corner)));
      }
    }
  }
  return bounds;
}

void drop_unused_meshes(Scene& scene) {
  std::vector<int> number(scene.meshes.size(), -1);
  for (const Instance& instance : scene.instances) number[static_cast<std::size_t>(instance.mesh)] = 0;
  std::vector<Mesh> kept;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = static_cast<int>(kept.size());
    kept.push_back(std::move(scene.meshes[i]));
  }
  scene.meshes = std::move(kept);
  for (Instance& instance : scene.instances) instance.mesh = number[static_cast<std::size_t>(instance.mesh)];
}

}  // namespace gatelight::scene
