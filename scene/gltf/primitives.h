#pragma once
// Converts one glTF primitive to one Mesh.

#include <span>

#include "scene/gltf/document.h"
#include "scene/gltf/pose.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Reads the attributes that the material needs, for the vertices that the triangles use, in a pose. `joints`
/// are those of the pose's skin; a skinned mesh is in the world. Points and lines give a mesh without
/// triangles. Thread-safe. Throws InputError.
Mesh load_primitive(const Document& document, const Pose& pose, int primitive,
                    std::span<const JointMatrix> joints, const Material& material, Warnings& warnings);

}  // namespace gatelight::scene::gltf
