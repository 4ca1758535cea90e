#pragma once
// The channels of animations: which value they animate, and the accessors with its keys.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/error.h"
#include "scene/gltf/references.h"

namespace gatelight::scene::gltf {

enum class Interpolation : std::uint8_t { step, linear, cubic_spline };

struct Channel {
  std::string where;    ///< for messages
  std::string pointer;  ///< JSON pointer to the animated value
  int times = -1;       ///< accessors
  int values = -1;
  Interpolation interpolation = Interpolation::linear;
};

/// The JSON pointer of an unchecked channel. Those without KHR_animation_pointer get the pointer that says
/// the same: /nodes/3/rotation. Empty where there is no target.
std::string pointer_of(const nlohmann::json& channel);

/// The names of a JSON pointer: nodes, 3, rotation.
std::vector<std::string_view> split_pointer(std::string_view pointer);

/// Prepares an unchecked animation for the schema: a channel becomes its pointer and its sampler. Channels
/// of what the scene does not show become empty, so that their accessors are not read. Throws InputError
/// for indices out of range.
void join_samplers(nlohmann::json& animation, std::size_t index, const References& references,
                   std::string_view file, Warnings& warnings);

/// Takes the animations out of the checked JSON. tinygltf reads no pointers.
std::vector<Channel> take_channels(nlohmann::json& root);

}  // namespace gatelight::scene::gltf
