#pragma once
// One glTF primitive to one Mesh.

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Reads what the material needs of primitive `primitive` of mesh `mesh`, and only the vertices that its
/// triangles use. A primitive of points or lines gives a mesh without triangles. Several threads may call it.
Mesh load_primitive(const Document& document, int mesh, int primitive, const Material& material,
                    Warnings& warnings);

}  // namespace gatelight::scene::gltf
