#include <fstream>  // the header forgets it without file access

#define TINYGLTF_IMPLEMENTATION
#include "scene/tinygltf.h"
