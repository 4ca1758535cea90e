#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace gatelight::tests {

/// A square of two by two metres in the plane z = 0, reflecting 0.5, seen by a camera at z = 3 named "front".
inline std::string tiny_scene() {
  return R"({
  "asset": {"version": "2.0"},
  "scene": 0,
  "scenes": [{"nodes": [0, 1]}],
  "nodes": [{"mesh": 0}, {"camera": 0, "name": "front", "translation": [0, 0, 3]}],
  "cameras": [{"name": "front", "type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
  "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3",
                 "min": [-1, -1, 0], "max": [1, 1, 0]}],
  "bufferViews": [{"buffer": 0, "byteLength": 72}],
  "buffers": [{"byteLength": 72, "uri": "data:application/octet-stream;base64,)"
         "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgL8AAAAA"
         "AACAPwAAgD8AAAAAAACAvwAAgD8AAAAA"
         R"("}]
})";
}

/// Adds a light of KHR_lights_punctual and a node for it.
inline void add_light(nlohmann::json& scene, nlohmann::json light,
                      nlohmann::json node = nlohmann::json::object()) {
  nlohmann::json& lights = scene["extensions"]["KHR_lights_punctual"]["lights"];
  node["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
  lights.push_back(std::move(light));
  scene["extensionsUsed"] = {"KHR_lights_punctual"};
  scene["scenes"][0]["nodes"].push_back(scene["nodes"].size());
  scene["nodes"].push_back(std::move(node));
}

}  // namespace gatelight::tests
