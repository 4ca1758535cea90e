#pragma once
// The extensions of glTF that the loader supports.

#include <string_view>

#include "scene/gltf/error.h"
#include "scene/gltf/json.h"

namespace gatelight::scene::gltf {

/// Throws InputError for an unsupported required extension; adds a warning for each unsupported used one.
void check_extensions(const json& root, std::string_view file, Warnings& warnings);

/// The extension of an object, or null.
const json* find_extension(const json& object, const char* name);

}  // namespace gatelight::scene::gltf
