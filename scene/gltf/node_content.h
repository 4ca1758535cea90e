#pragma once
// Converts the cameras, lights and instances that a node refers to.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace gatelight::scene::gltf {

Camera make_camera(const Document& document, int node, const Eigen::Affine3d& world);
/// Nothing, with a warning, for a light of an unknown type.
std::optional<PunctualLight> make_light(const Document& document, int node, int light,
                                        const Eigen::Affine3d& world, Warnings& warnings);

/// The attributes of EXT_mesh_gpu_instancing: an accessor for each name.
std::map<std::string, int> instance_attributes(const tinygltf::Value& extension);

/// The transforms of EXT_mesh_gpu_instancing, relative to the node.
std::vector<Eigen::Affine3d> read_instances(const Document& document,
                                            const std::map<std::string, int>& attributes,
                                            const std::string& where, Warnings& warnings);

/// The inverse bind matrices of a skin with this many joints: the identity where the file has none.
std::vector<Eigen::Affine3d> read_inverse_bind_matrices(const Document& document, int accessor,
                                                        std::size_t joints);

}  // namespace gatelight::scene::gltf
