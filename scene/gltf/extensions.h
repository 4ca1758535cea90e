#pragma once
// The extensions of glTF that the loader supports.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

/// Throws InputError for an unsupported required extension that may change the picture and that is not
/// ignored; adds a warning for each other unsupported one.
void check_extensions(const nlohmann::json& root, const std::vector<std::string>& ignored,
                      std::string_view file, Warnings& warnings);

}  // namespace gatelight::scene::gltf
