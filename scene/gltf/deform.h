#pragma once
// Morph targets and skins: the vertices of a primitive in its pose (glTF 2.0, sections 3.7.2.2 and 3.7.3).

#include <span>
#include <vector>

#include "scene/gltf/pose.h"
#include "scene/gltf/vertices.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

/// Adds the targets, each times its weight, to the positions, and to normals and tangents where there are
/// any. Targets without a weight have weight 0. Throws InputError.
void morph(const Vertices& vertices, const tinygltf::Primitive& primitive, std::span<const double> weights,
           Selection selection, Mesh& mesh);

/// Linear blend skinning by any number of sets of joints and weights: moves positions, normals and tangents
/// to the world. Weights are divided by their sum. A vertex without weights follows the first joint. Normals
/// may have any length afterwards. `joints` is not empty. Throws InputError for a joint that is not there.
void apply_skin(const Document& document, const Vertices& vertices, std::span<const JointMatrix> joints,
                Selection selection, Mesh& mesh, Warnings& warnings);

}  // namespace gatelight::scene::gltf
