#include <fstream>  // the header forgets it without file access

#define TINYGLTF_IMPLEMENTATION
#include "scene/gltf/tinygltf.h"
