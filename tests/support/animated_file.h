#pragma once
// A small glTF file with animations.

#include <string>
#include <utility>
#include <vector>

#include "tests/support/gltf_builder.h"

namespace gatelight::scene {

struct AnimatedFile : GltfBuilder {
  using Floats = std::vector<float>;

  int seconds(const Floats& times) {
    return accessor(times, kFloat, "SCALAR", times.size(), {{"max", {times.empty() ? 0.0f : times.back()}}});
  }
  int vectors(const Floats& v) { return accessor(v, kFloat, "VEC3", v.size() / 3); }
  int quaternions(const Floats& v) { return accessor(v, kFloat, "VEC4", v.size() / 4); }
  int scalars(const Floats& v) { return accessor(v, kFloat, "SCALAR", v.size()); }

  int animation(const std::string& name) {
    return add("animations", {{"name", name}, {"channels", json::array()}, {"samplers", json::array()}});
  }

  /// Accessors. In braces the times are made first, so that every compiler numbers them alike.
  struct Keys {
    int times;
    int values;
  };

  /// Adds a channel to the last animation, or to a first one.
  void channel(json target, Keys keys, const char* interpolation = "LINEAR") {
    if (!root.contains("animations")) animation("only");
    json& last = root["animations"].back();
    last["channels"].push_back({{"sampler", last["samplers"].size()}, {"target", std::move(target)}});
    last["samplers"].push_back(
        {{"input", keys.times}, {"output", keys.values}, {"interpolation", interpolation}});
  }

  void move(int node, const char* path, Keys keys, const char* interpolation = "LINEAR") {
    channel({{"node", node}, {"path", path}}, keys, interpolation);
  }
  void move(const std::string& pointer, Keys keys, const char* interpolation = "LINEAR") {
    channel({{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}, keys,
            interpolation);
  }

  Scene at(double time, const std::string& animation = "") {
    return load({.time = time, .animation = animation, .bake_transforms = false});
  }
  /// The transform of the only instance.
  Affine transform_at(double time) {
    const Scene scene = at(time);
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    return scene.instances.at(0).transform;
  }
  /// Its place.
  Vec3 place_at(double time) { return transform_at(time).translation(); }
};

/// A triangle on node 0.
inline AnimatedFile moving_triangle(json node = json::object()) {
  AnimatedFile file;
  node["mesh"] = file.mesh(file.triangle());
  file.node(std::move(node));
  return file;
}

/// Moves its node by places at these seconds.
inline AnimatedFile translated_triangle(const AnimatedFile::Floats& seconds,
                                        const AnimatedFile::Floats& places,
                                        const char* interpolation = "LINEAR") {
  AnimatedFile file = moving_triangle();
  file.move(0, "translation", {file.seconds(seconds), file.vectors(places)}, interpolation);
  return file;
}

/// Turns its node by quaternions at these seconds.
inline AnimatedFile rotated_triangle(const AnimatedFile::Floats& seconds,
                                     const AnimatedFile::Floats& quaternions,
                                     const char* interpolation = "LINEAR") {
  AnimatedFile file = moving_triangle();
  file.move(0, "rotation", {file.seconds(seconds), file.quaternions(quaternions)}, interpolation);
  return file;
}

/// A triangle with two morph targets, which move its first vertex along x and y, and weights of
/// 0.25 and 0.5.
inline AnimatedFile morphing_triangle() {
  AnimatedFile file;
  json primitive = file.triangle();
  primitive["targets"] = {{{"POSITION", file.vectors({1, 0, 0, 0, 0, 0, 0, 0, 0})}},
                          {{"POSITION", file.vectors({0, 1, 0, 0, 0, 0, 0, 0, 0})}}};
  file.add("meshes", {{"primitives", {primitive}}, {"weights", {0.25, 0.5}}});
  file.node({{"mesh", 0}});
  return file;
}

}  // namespace gatelight::scene
