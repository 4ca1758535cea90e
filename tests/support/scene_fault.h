#pragma once
// Invariants of any scene that loads: the renderer relies on them.

#include <cmath>
#include <string>

#include "scene/scene.h"

namespace gatelight::scene {

/// The first violated invariant; empty where there is none.
inline std::string scene_fault(const Scene& scene) {
  const auto unit = [](const Vec3& v) { return std::abs(v.norm() - 1.0f) <= 1e-4f; };
  const auto index = [](int i, std::size_t size) { return i >= 0 && static_cast<std::size_t>(i) < size; };
  for (const Instance& instance : scene.instances) {
    if (!index(instance.mesh, scene.meshes.size())) return "an instance of no mesh";
    if (!instance.transform.matrix().allFinite()) return "a transform that is not finite";
  }
  for (const Mesh& mesh : scene.meshes) {
    const std::size_t n = mesh.positions.size();
    if (!index(mesh.material, scene.materials.size())) return "a mesh of no material";
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t i : t) {
        if (i >= n) return "an index beyond the vertices";
      }
    }
    for (const Vec3& p : mesh.positions) {
      if (!p.allFinite()) return "a position that is not finite";
    }
    for (const Vec3& v : mesh.normals) {
      if (!unit(v)) return "a normal that is no unit vector";
    }
    for (const Vec4& t : mesh.tangents) {
      if (!unit(t.head<3>())) return "a tangent that is no unit vector";
    }
    for (const std::size_t size :
         {mesh.normals.size(), mesh.tangents.size(), mesh.uv0.size(), mesh.uv1.size(), mesh.colors.size()}) {
      if (size != 0 && size != n) return "an attribute of another length than the positions";
    }
    for (const auto* uvs : {&mesh.uv0, &mesh.uv1}) {
      for (const Vec2& uv : *uvs) {
        if (!uv.allFinite()) return "texture coordinates that are not finite";
      }
    }
    for (const Vec4& color : mesh.colors) {
      if (!((color.array() >= 0.0f).all() && (color.array() <= 1.0f).all())) return "a colour out of range";
    }
  }
  for (const Texture& texture : scene.textures) {
    if (!index(texture.image, scene.images.size())) return "a texture of no image";
  }
  for (const Image& image : scene.images) {
    const std::size_t size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                             static_cast<std::size_t>(image.channels);
    if (image.pixels.size() != size || size == 0) return "an image of another size than its pixels";
  }
  for (const std::string& warning : scene.warnings) {
    if (warning.find('\n') != std::string::npos) return "a warning of two lines";
  }
  return "";
}

}  // namespace gatelight::scene
