#pragma once
// The animations of a file, and those of them that LoadOptions choose.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

#include "scene/gltf.h"
#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

/// All animations of unchecked JSON. Flaws of animations make no error.
std::vector<Animation> list_animations(const nlohmann::json& root);

/// The indices of those that `time` shows. Throws InputError for an unknown name.
std::vector<std::size_t> choose_animations(const nlohmann::json& root, const LoadOptions& options,
                                           std::string_view file, Warnings& warnings);

}  // namespace gatelight::scene::gltf
