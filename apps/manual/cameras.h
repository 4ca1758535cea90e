#pragma once
// The names of a scene's cameras, without loading the scene.

#include <filesystem>
#include <string>
#include <vector>

namespace gatelight::apps {

/// Each once, in the order of their nodes; names with control characters are left out. None for a file that
/// is no glTF or cannot be read. Reads only the JSON of a .glb.
std::vector<std::string> camera_names(const std::filesystem::path& scene);

}  // namespace gatelight::apps
