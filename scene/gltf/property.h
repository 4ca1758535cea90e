#pragma once
// Finds the value behind a JSON pointer in tinygltf's model, so that an animation can change it.

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "scene/gltf/curve.h"
#include "scene/gltf/error.h"
#include "scene/gltf/model.h"

namespace gatelight::scene::gltf {

struct Property {
  CurveShape shape;
  double low = 0.0;                                  ///< the range that the schema allows
  double high = 0.0;                                 ///< larger values become this
  double below = 0.0;                                ///< smaller values become this
  std::function<void(std::span<const double>)> set;  ///< the model must outlive it, and keep its lists
};

/// Nothing for a pointer to a value that is not there, or that the loader does not read, or that no
/// animation can change.
/// A node's matrix becomes translation, rotation and scale if one of them is animated.
std::optional<Property> find_property(tinygltf::Model& model, std::string_view pointer, Warnings& warnings);

}  // namespace gatelight::scene::gltf
