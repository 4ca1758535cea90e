#pragma once
// Where buffers and images outside the file come from: data URIs, and files in the scene's own folder.

#include <filesystem>
#include <string_view>

#include "scene/gltf/container.h"

namespace gatelight::scene::gltf {

struct UriOptions {
  std::filesystem::path folder;  ///< of the scene
  bool allow_external = false;
};

/// The bytes behind a URI. Relative paths (percent-encoded or not) stay inside the folder; absolute paths,
/// other schemes than data:, and paths that climb out of the folder, by a symbolic link too, are refused
/// unless `allow_external` is set. Then file: is a scheme, too. Throws SceneError.
OwnedBytes read_uri(std::string_view uri, const UriOptions& options, std::string_view file,
                    std::string_view where);

/// The URI as a message should show it: a data URI is cut after its type.
std::string uri_name(std::string_view uri);

}  // namespace gatelight::scene::gltf
