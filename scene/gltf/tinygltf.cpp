#include <fstream>  // tiny_gltf.h does not include it when file access is disabled

#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/tinygltf.h"
