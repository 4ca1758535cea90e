#pragma once
// Converts one glTF primitive to one Mesh.

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Reads the attributes that the material needs, for the vertices that the triangles use. Points and lines
/// give a mesh without triangles. Thread-safe. Throws InputError.
Mesh load_primitive(const Document& document, int mesh, int primitive, const Material& material,
                    Warnings& warnings);

}  // namespace gatelight::scene::gltf
