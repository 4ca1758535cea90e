#pragma once
// KHR_meshopt_compression and EXT_meshopt_compression: libmeshoptimizer decodes a buffer view.

#include <string_view>

#include "scene/gltf/container.h"
#include "scene/gltf/model.h"

namespace gatelight::scene::gltf {

/// `length` is the buffer view's byteLength, which the decoded data must have. Throws InputError.
OwnedBytes decode_meshopt(Bytes source, const tinygltf::Value& extension, std::size_t length,
                          std::string_view file, std::string_view where);

}  // namespace gatelight::scene::gltf
