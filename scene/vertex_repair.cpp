#include "scene/vertex_repair.h"

#include <cmath>

namespace gatelight::scene {
namespace {

/// Returns false if the vector has no direction.
bool normalize(Vec3& v) {
  if (!v.allFinite()) return false;
  const float squared = v.squaredNorm();
  if (squared > 1e-30f && squared < 1e30f) {
    v /= std::sqrt(squared);
    return true;
  }
  v.stableNormalize();
  return v.allFinite() && v.squaredNorm() > 0.5f;
}

}  // namespace

bool repair_normals(Mesh& mesh) {
  std::vector<char> broken;
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (normalize(mesh.normals[i])) continue;
    if (broken.empty()) broken.resize(mesh.normals.size(), 0);
    broken[i] = 1;
    mesh.normals[i].setZero();
  }
  if (broken.empty()) return false;
  for (const auto& t : mesh.triangles) {
    if (!broken[t[0]] && !broken[t[1]] && !broken[t[2]]) continue;
    const Vec3& p = mesh.positions[t[0]];
    const Vec3 n = (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p);
    for (const std::uint32_t i : t) {
      if (broken[i] && n.allFinite()) mesh.normals[i] += n;
    }
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (broken[i] && !normalize(mesh.normals[i])) mesh.normals[i] = Vec3::UnitY();
  }
  return true;
}

bool repair_uvs(Mesh& mesh) {
  bool any = false;
  for (std::vector<Vec2>* uvs : {&mesh.uv0, &mesh.uv1}) {
    for (Vec2& uv : *uvs) {
      if (uv.allFinite()) continue;
      uv.setZero();
      any = true;
    }
  }
  return any;
}

void repair_tangents(Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
    Vec3 direction = mesh.tangents[i].head<3>();
    if (!normalize(direction)) direction = any_perpendicular(mesh.normals[i]);
    const float side = mesh.tangents[i].w() < 0.0f ? -1.0f : 1.0f;
    mesh.tangents[i] = Vec4(direction.x(), direction.y(), direction.z(), side);
  }
}

}  // namespace gatelight::scene
