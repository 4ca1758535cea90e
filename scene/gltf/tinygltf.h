#pragma once
// Includes tinygltf under a namespace name of our own.
//
// Debian's libdraco exports an older tinygltf with different structs. A program that links both takes some
// functions from each and crashes, depending on the link order. File access and image decoders are disabled
// because the loader does both itself.

#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define tinygltf gatelight_tinygltf
#include <tiny_gltf.h>
#undef tinygltf

namespace gatelight::scene::gltf {
namespace tinygltf = ::gatelight_tinygltf;
}
