#pragma once
// The extensions of glTF that the loader supports.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

/// Throws InputError for an unsupported required extension; adds a warning for each unsupported used one.
void check_extensions(const nlohmann::json& root, std::string_view file, Warnings& warnings);

}  // namespace gatelight::scene::gltf
