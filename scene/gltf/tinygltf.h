#pragma once
// tinygltf, compiled here under a name of its own.
//
// Debian's libdraco exports a second, older tinygltf. In a program that uses both libraries the loader takes
// half of the functions from the one and half from the other, whose structs differ: it crashes, depending on
// the link order. Without file access and without image decoders, too: this program does both itself.

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
