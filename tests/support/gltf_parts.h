#pragma once
// Parts of small glTF files that several tests need.

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {

/// An accessor without data, which are zeros.
inline int zeros(GltfBuilder& file, int component_type, const char* type, std::size_t count,
                 json more = json::object()) {
  json a = {{"componentType", component_type}, {"type", type}, {"count", count}};
  a.update(more);
  return file.add("accessors", a);
}

inline int accessor_of_view(GltfBuilder& file, int view, int component_type, const char* type,
                            std::size_t count, json more = json::object()) {
  more["bufferView"] = view;
  return zeros(file, component_type, type, count, std::move(more));
}

/// The `sparse` member of an accessor.
template <typename Index, typename Value>
json sparse_entries(GltfBuilder& file, const std::vector<Index>& indices, int index_type,
                    const std::vector<Value>& values) {
  return {{"count", indices.size()},
          {"indices", {{"bufferView", file.view(indices)}, {"componentType", index_type}}},
          {"values", {{"bufferView", file.view(values)}}}};
}

/// Names the .glb's data as buffer 0, so that further buffers can follow.
inline void name_buffers(GltfBuilder& file, const json& further = json::array()) {
  while (file.bin.size() % 4 != 0) file.bin.push_back(0);
  file.root["buffers"] = {{{"byteLength", file.bin.size()}}};
  for (const json& buffer : further) file.root["buffers"].push_back(buffer);
}

/// A node with a triangle.
inline GltfBuilder triangle_file() {
  GltfBuilder file;
  file.node({{"mesh", file.mesh(file.triangle())}});
  return file;
}

/// A triangle with a material of these properties.
inline GltfBuilder triangle_of(const json& material) {
  GltfBuilder file;
  json primitive = file.triangle();
  primitive["material"] = file.add("materials", material);
  file.node({{"mesh", file.mesh(primitive)}});
  return file;
}

/// A triangle with this picture.
inline GltfBuilder with_image(const json& image) {
  GltfBuilder file = triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add("images", image);
  file.add("textures", {{"source", 0}});
  return file;
}

/// A triangle whose vertices follow joint 0.
inline json triangle_of_joint(GltfBuilder& file) {
  json primitive = file.triangle();
  primitive["attributes"]["JOINTS_0"] =
      file.accessor(std::vector<std::uint8_t>(12, 0), kUnsignedByte, "VEC4", 3);
  primitive["attributes"]["WEIGHTS_0"] =
      file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 3);
  return primitive;
}

/// Adds a camera, and returns its index.
inline int camera(GltfBuilder& file) {
  return file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
}

/// The extensions of a node with a punctual light.
inline json light_of_node(int index) {
  return {{"KHR_lights_punctual", {{"light", index}}}};
}

/// Sets the punctual lights of the file.
inline void set_lights(GltfBuilder& file, const json& lights) {
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = lights;
}

/// The extensions of a node that places its mesh by accessors.
inline json instancing(const json& attributes) {
  return {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}};
}

}  // namespace gatelight::scene
