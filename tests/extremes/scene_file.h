#pragma once
// A scene made in code, as a file: baked meshes, materials without textures, one camera.

#include <array>
#include <string>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace gatelight::testing {

inline nlohmann::json triple(const Color& c) {
  return {c.x(), c.y(), c.z()};
}

inline nlohmann::json material_json(const scene::Material& m) {
  nlohmann::json json = {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {m.base_color.x(), m.base_color.y(), m.base_color.z(), m.base_alpha}},
        {"metallicFactor", m.metallic},
        {"roughnessFactor", m.roughness}}},
      {"doubleSided", m.double_sided}};
  if (m.emits()) {
    const float strength = m.emission.maxCoeff();
    json["emissiveFactor"] = triple(m.emission / strength);
    json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
  }
  if (m.alpha_mode == scene::AlphaMode::blend) json["alphaMode"] = "BLEND";
  if (m.specular != 1.0f) json["extensions"]["KHR_materials_specular"] = {{"specularFactor", m.specular}};
  if (m.transmits())
    json["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", m.transmission}};
  if (m.has_volume()) json["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", m.thickness}};
  return json;
}

/// All meshes and the camera under one node at `translation`.
inline scene::GltfBuilder file_of(const scene::Scene& scene, const scene::Camera& camera,
                                  const std::array<double, 3>& translation) {
  scene::GltfBuilder file;
  file.root["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_materials_specular",
                                 "KHR_materials_transmission", "KHR_materials_volume"};
  for (const scene::Material& m : scene.materials) file.add("materials", material_json(m));
  nlohmann::json children = nlohmann::json::array();
  const auto child = [&](nlohmann::json node) { children.push_back(file.add("nodes", std::move(node))); };
  for (const scene::Mesh& mesh : scene.meshes) {
    const auto floats = [](const auto& values) {
      std::vector<float> list;
      for (const Vec3& v : values) list.insert(list.end(), {v.x(), v.y(), v.z()});
      return list;
    };
    std::vector<std::uint32_t> indices;
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    nlohmann::json primitive = {{"attributes", {{"POSITION", file.positions(floats(mesh.positions))}}},
                                {"indices", file.indices(indices)},
                                {"material", mesh.material}};
    if (!mesh.normals.empty()) primitive["attributes"]["NORMAL"] = file.positions(floats(mesh.normals));
    child({{"mesh", file.mesh(std::move(primitive))}});
  }
  const Eigen::Quaterniond q(camera.transform.linear().cast<double>());
  const Eigen::Vector3d eye = camera.transform.translation().cast<double>();
  file.add("cameras",
           {{"type", "perspective"}, {"perspective", {{"yfov", camera.vertical_fov}, {"znear", 0.01}}}});
  child({{"camera", 0},
         {"rotation", {q.x(), q.y(), q.z(), q.w()}},
         {"translation", {eye.x(), eye.y(), eye.z()}}});
  file.node({{"children", children}, {"translation", translation}});
  return file;
}

}  // namespace gatelight::testing
