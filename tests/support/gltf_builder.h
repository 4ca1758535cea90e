#pragma once
// Small glTF files, written by the tests themselves.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "scene/gltf.h"
#include "tests/support/made_glb.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::scene {

using nlohmann::json;
using tests::TemporaryFolder;

inline constexpr int kByte = 5120;
inline constexpr int kUnsignedByte = 5121;
inline constexpr int kShort = 5122;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kFloat = 5126;

inline void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// The error of load_gltf; empty when it loads.
inline std::string refusal(const std::filesystem::path& path, const LoadOptions& options = {}) {
  return tests::refusal<InputError>([&] { load_gltf(path, options); });
}

/// Expects a refusal with a message that has the path and all the names in it.
inline void expect_refused(const std::filesystem::path& path, tests::NameList names,
                           const LoadOptions& options = {}, tests::Place place = tests::Place::current()) {
  names.push_back(path.string());
  tests::expect_message(refusal(path, options), names, place);
}

class GltfBuilder {
 public:
  json root = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> bin;

  /// Adds an element to one of the root's lists and returns its index.
  int add(const char* list, json element) {
    root[list].push_back(std::move(element));
    return static_cast<int>(root[list].size()) - 1;
  }

  template <typename T>
  int view(const std::vector<T>& data, json more = json::object()) {
    while (bin.size() % 4 != 0) bin.push_back(0);
    const std::size_t offset = bin.size();
    bin.resize(offset + data.size() * sizeof(T));
    if (!data.empty()) std::memcpy(bin.data() + offset, data.data(), data.size() * sizeof(T));
    json v = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", data.size() * sizeof(T)}};
    v.update(more);
    return add("bufferViews", v);
  }

  template <typename T>
  int accessor(const std::vector<T>& data, int component_type, const char* type, std::size_t count,
               json more = json::object()) {
    json a = {
        {"bufferView", view(data)}, {"componentType", component_type}, {"type", type}, {"count", count}};
    a.update(more);
    return add("accessors", a);
  }

  int positions(const std::vector<float>& xyz) { return accessor(xyz, kFloat, "VEC3", xyz.size() / 3); }
  int indices(const std::vector<std::uint32_t>& list) {
    return accessor(list, kUnsignedInt, "SCALAR", list.size());
  }

  int mesh(json primitive) { return add("meshes", {{"primitives", {std::move(primitive)}}}); }

  /// (0,0,0) (1,0,0) (0,1,0), with UVs (0,1) (1,1) (0,0): a picture stands upright on it.
  json triangle() {
    return {{"attributes",
             {{"POSITION", positions({0, 0, 0, 1, 0, 0, 0, 1, 0})},
              {"TEXCOORD_0", accessor(std::vector<float>{0, 1, 1, 1, 0, 0}, kFloat, "VEC2", 3)}}}};
  }

  /// A node in the (only) scene.
  int node(json n) {
    const int index = add("nodes", std::move(n));
    if (!root.contains("scenes")) root["scenes"] = {{{"nodes", json::array()}}};
    root["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  std::vector<std::uint8_t> glb() {
    finish();
    std::string text = root.dump();
    while (text.size() % 4 != 0) text.push_back(' ');
    std::vector<std::uint8_t> parts(text.begin(), text.end());
    parts.push_back(0);
    parts.insert(parts.end(), bin.begin(), bin.end());
    return tests::made_glb(parts);
  }

  std::filesystem::path write(const TemporaryFolder& folder, const std::string& name = "test.glb") {
    const std::filesystem::path path = folder.path() / name;
    write_bytes(path, glb());
    return path;
  }

  Scene load(const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return load_gltf(write(folder), options);
  }

  std::string refused(const LoadOptions& options = {}) {
    const TemporaryFolder folder;
    return refusal(write(folder), options);
  }

  void expect_refused(const tests::NameList& names, const LoadOptions& options = {},
                      tests::Place place = tests::Place::current()) {
    const TemporaryFolder folder;
    scene::expect_refused(write(folder), names, options, place);
  }

 private:
  void finish() {
    while (bin.size() % 4 != 0) bin.push_back(0);
    if (bin.empty()) bin.resize(4);
    if (!root.contains("buffers")) root["buffers"] = {{{"byteLength", bin.size()}}};
  }
};

/// The only mesh of a scene with the transform of its only instance.
inline const Mesh& only_mesh(const Scene& scene) {
  EXPECT_EQ(scene.meshes.size(), 1u);
  return scene.meshes.at(0);
}

}  // namespace gatelight::scene
