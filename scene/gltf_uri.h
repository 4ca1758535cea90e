#pragma once
// Where buffers and images outside the file come from: data URIs, and files in the scene's own folder.

#include <filesystem>
#include <string_view>

#include "scene/gltf_container.h"

namespace gatelight::scene::gltf {

/// The bytes behind a URI. Relative paths (percent-encoded or not) stay inside `folder`; absolute paths,
/// other schemes than data: and paths that climb out of the folder are refused. Throws SceneError.
OwnedBytes read_uri(std::string_view uri, const std::filesystem::path& folder, std::string_view file,
                    std::string_view where);

/// The URI as a message should show it: a data URI is cut after its type.
std::string uri_name(std::string_view uri);

}  // namespace gatelight::scene::gltf
