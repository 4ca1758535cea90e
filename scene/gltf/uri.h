#pragma once
// Reads buffers and images outside the file: data URIs, and files in the scene's folder.

#include <filesystem>
#include <string_view>

#include "scene/gltf/container.h"

namespace gatelight::scene::gltf {

struct UriOptions {
  std::filesystem::path folder;  ///< the scene's folder
  bool allow_external = false;
};

/// The bytes behind a URI. Without `allow_external` it must be a data URI or a relative path (percent-encoded
/// or not) that stays inside the folder, also through symbolic links. With it, absolute paths, paths out of
/// the folder and file: URIs are allowed. Backslashes are slashes, with a warning, unless a file has them in
/// its name. Throws InputError.
OwnedBytes read_uri(std::string_view uri, const UriOptions& options, std::string_view file,
                    std::string_view where, Warnings& warnings);

/// The URI for messages; a data URI is cut after its type.
std::string uri_name(std::string_view uri);

}  // namespace gatelight::scene::gltf
