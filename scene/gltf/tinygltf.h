#pragma once
// Includes tinygltf under a namespace name of our own.
//
// Debian's libdraco exports an older tinygltf with other structs. A program that links both would take some
// functions from each and crash, depending on the order of the libraries. tinygltf's own file access and its
// decoders of pictures are left out: the loader has both itself, with limits.

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#define tinygltf gatelight_tinygltf
#include <tiny_gltf.h>
#undef tinygltf

#include <nlohmann/json_fwd.hpp>

namespace gatelight::scene::gltf {

namespace tinygltf = ::gatelight_tinygltf;

/// Reads a checked glTF file's JSON into `model`. Returns false and sets `error` if tinygltf refuses it.
bool load_json(tinygltf::TinyGLTF& reader, nlohmann::json&& root, tinygltf::Model& model, std::string& error);

}  // namespace gatelight::scene::gltf
